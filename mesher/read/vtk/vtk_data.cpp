// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/vtk/vtk_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "format/error.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/file/file.hpp"

namespace palpate::mesher {
namespace {

/// Arrays of more different values are measurements or numbers of entities, not groups.
constexpr std::size_t kMostGroups = 64;

struct CellShape {
  int type;
  std::size_t points;  ///< 0: any number
  const char* solid;   ///< name of a volume element, plural; null for others
};
constexpr std::array kCellShapes{CellShape{VtkVertex, 1, nullptr},
                                 CellShape{VtkPolyVertex, 0, nullptr},
                                 CellShape{VtkLine, 2, nullptr},
                                 CellShape{VtkPolyLine, 0, nullptr},
                                 CellShape{VtkTriangle, 3, nullptr},
                                 CellShape{VtkStrip, 0, nullptr},
                                 CellShape{VtkPolygon, 0, nullptr},
                                 CellShape{VtkPixel, 4, nullptr},
                                 CellShape{VtkQuad, 4, nullptr},
                                 CellShape{VtkTetrahedron, 4, "tetrahedra"},
                                 CellShape{11, 8, "voxels"},
                                 CellShape{12, 8, "hexahedra"},
                                 CellShape{13, 6, "wedges"},
                                 CellShape{14, 5, "pyramids"},
                                 CellShape{VtkQuadraticEdge, 3, nullptr},
                                 CellShape{VtkQuadraticTriangle, 6, nullptr},
                                 CellShape{VtkQuadraticQuad, 8, nullptr},
                                 CellShape{VtkQuadraticTetrahedron, 10, "quadratic tetrahedra"},
                                 CellShape{25, 20, "quadratic hexahedra"},
                                 CellShape{26, 15, "quadratic wedges"},
                                 CellShape{27, 13, "quadratic pyramids"},
                                 CellShape{28, 9, nullptr},
                                 CellShape{29, 27, "quadratic hexahedra"},
                                 CellShape{42, 0, "polyhedra"},
                                 CellShape{71, 0, "tetrahedra of higher order"},
                                 CellShape{72, 0, "hexahedra of higher order"}};

const CellShape* shape_of(int type) {
  const auto found = std::find_if(kCellShapes.begin(), kCellShapes.end(),
                                  [&](const CellShape& shape) { return shape.type == type; });
  return found == kCellShapes.end() ? nullptr : &*found;
}

bool is_tetrahedron(int type) {
  return type == VtkTetrahedron || type == VtkQuadraticTetrahedron;
}

std::string label_of(const VtkArray& array, std::size_t row) {
  return text(array.name, "=", static_cast<std::int64_t>(array.values[row]));
}

/// Whether the values name groups. Then `values` are those that occur.
bool names_groups(const VtkArray& array, std::set<double>& values) {
  if (!array.is_integral || array.components != 1) return false;
  for (const double value : array.values) {
    values.insert(value);
    if (values.size() > kMostGroups) return false;
  }
  return !values.empty();
}

/// Adds the set of each value of the array. @param add adds the nodes of a row to a set
template <class Add>
void add_sets(const VtkArray& array, const Add& add) {
  std::set<double> values;
  if (!names_groups(array, values)) return;
  const bool is_mark = *values.begin() == 0 && *values.rbegin() == 1 && values.size() == 2;
  for (std::size_t row = 0; row < array.values.size(); ++row) {
    if (!is_mark) add(label_of(array, row), row);
    if (is_mark && array.values[row] != 0) add(array.name, row);
  }
}

std::string names_of(const std::vector<const VtkArray*>& arrays) {
  std::string list;
  for (const VtkArray* array : arrays) list += (list.empty() ? "" : ", ") + array->name;
  return list;
}

/// The cell array whose values are the regions; null where there is none.
const VtkArray* region_array_of(const VtkData& data, const std::string& wanted,
                                const std::string& where) {
  std::vector<const VtkArray*> candidates;
  for (const VtkArray& array : data.cell_arrays)
    if (array.is_integral && array.components == 1) candidates.push_back(&array);
  if (!wanted.empty()) {
    for (const VtkArray* array : candidates)
      if (array->name == wanted) return array;
    refuse_geometry(where, text("there is no integer cell array '", wanted, "'"),
                    candidates.empty() ? "the file has none: remove region_array from the case"
                                       : "use one of " + names_of(candidates));
  }
  for (const char* usual :
       {"region", "regions", "region_id", "material", "materials", "material_id", "materialid",
        "gmsh:physical", "medit:ref", "physical", "attribute", "label", "labels", "cellentityids"})
    for (const VtkArray* array : candidates)
      if (lower(array->name) == usual) return array;
  if (candidates.size() > 1) {
    refuse_geometry(
        where, text("several integer cell arrays may hold the regions: ", names_of(candidates)),
        "set region_array in [volume_mesh] to one of them");
  }
  return candidates.empty() ? nullptr : candidates.front();
}

/// The names of the regions by the rows of a cell array.
class RegionNames {
 public:
  RegionNames(const VtkData& data, const VtkArray* array) : array_(array) {
    const auto found = data.texts.find("region_names");
    if (found != data.texts.end()) names_ = found->second;
  }
  std::string at(std::size_t cell) const {
    if (array_ == nullptr) return kUnnamedRegion;
    const double value = array_->values[cell];
    const auto row = static_cast<std::size_t>(value);
    return value >= 0 && row < names_.size() ? names_[row] : label_of(*array_, cell);
  }

 private:
  const VtkArray* array_;
  std::vector<std::string> names_;
};

void add_cell(MeshEntities& entities, const VtkData& data, std::size_t cell,
              const RegionNames& regions) {
  const int type = data.types[cell];
  if (!is_tetrahedron(type)) {
    if (const char* solid = shape_of(type)->solid) ++entities.other_solids[solid];
    return;
  }
  ListedTetrahedron& t = entities.tetrahedra.emplace_back();
  for (std::size_t i = data.begin_of(cell); i < data.end_of(cell); ++i)
    t.nodes[i - data.begin_of(cell)] = static_cast<std::int32_t>(data.connectivity[i]);
  t.quadratic = type == VtkQuadraticTetrahedron;
  t.number = static_cast<std::int64_t>(cell);
  t.region = entities.region(regions.at(cell));
}

/// The polygon, or the triangles of a strip.
void add_polygons(Soup& soup, const VtkData& data, std::size_t cell, const Names& names) {
  std::vector<std::size_t> corners;
  for (std::size_t i = data.begin_of(cell); i < data.end_of(cell); ++i)
    corners.push_back(static_cast<std::size_t>(data.connectivity[i]));
  const std::size_t before = soup.polygons.size();
  const int type = data.types[cell];
  if (type == VtkStrip) {
    for (std::size_t k = 0; k + 2 < corners.size(); ++k)
      soup.polygons.push_back({corners[k + k % 2], corners[k + 1 - k % 2], corners[k + 2]});
  } else if (type == VtkPixel) {
    soup.polygons.push_back({corners[0], corners[1], corners[3], corners[2]});
  } else if (type == VtkQuadraticTriangle) {
    corners.resize(3);
    soup.polygons.push_back(corners);
  } else if (type == VtkTriangle || type == VtkPolygon || type == VtkQuad) {
    soup.polygons.push_back(corners);
  }
  const auto known = std::find(soup.known_names.begin(), soup.known_names.end(), names);
  const auto index = static_cast<std::size_t>(known - soup.known_names.begin());
  if (known == soup.known_names.end()) soup.known_names.push_back(names);
  soup.names.resize(soup.names.size() + soup.polygons.size() - before, index);
}

}  // namespace

VtkArray vtk_array(std::string name, std::size_t components, bool is_integral,
                   std::vector<double> values) {
  constexpr double largest = 9e15;  // exact in a double
  const bool fits = std::all_of(values.begin(), values.end(),
                                [](double value) { return std::abs(value) < largest; });
  return {std::move(name), components, is_integral && fits, std::move(values)};
}

void check_cells(const VtkData& data, const std::string& where) {
  const auto refuse = [&](std::size_t cell, const std::string& problem) {
    refuse_geometry(where, text("cell ", cell, " ", problem), kDamagedFile);
  };
  const auto size = static_cast<std::int64_t>(data.connectivity.size());
  const auto points = static_cast<std::int64_t>(data.points.size());
  std::int64_t begin = 0;
  for (std::size_t cell = 0; cell < data.types.size(); ++cell) {
    const std::int64_t end = data.offsets[cell];
    if (end < begin || end > size) refuse(cell, text("ends at ", end, " of ", size, " indices"));
    const CellShape* shape = shape_of(data.types[cell]);
    if (shape == nullptr)
      refuse(cell, text("has type ", data.types[cell], ", which palpate does not know"));
    const auto count = static_cast<std::size_t>(end - begin);
    if (shape->points != 0 && count != shape->points) {
      refuse(cell, text("has ", count, " points, ", shape->points, " expected"));
    }
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t point = data.connectivity[static_cast<std::size_t>(i)];
      if (point < 0 || point >= points) {
        refuse(cell, text("has point ", point, " of ", points, " points"));
      }
    }
    begin = end;
  }
}

MeshEntities volume_entities(const VtkData& data, const std::string& region_array,
                             const std::string& where) {
  MeshEntities entities;
  entities.nodes = data.points;
  for (std::size_t i = 0; i < data.points.size(); ++i)
    entities.node_numbers.push_back(static_cast<std::int64_t>(i));
  const VtkArray* regions = region_array_of(data, region_array, where);
  const RegionNames names(data, regions);
  for (std::size_t cell = 0; cell < data.types.size(); ++cell)
    add_cell(entities, data, cell, names);
  for (const VtkArray& array : data.point_arrays)
    add_sets(array, [&](const std::string& set, std::size_t row) {
      entities.node_sets[set].push_back(static_cast<std::int32_t>(row));
    });
  for (const VtkArray& array : data.cell_arrays)
    add_sets(array, [&](const std::string& set, std::size_t row) {
      // The sets of the regions are made with the body.
      if (&array == regions && is_tetrahedron(data.types[row])) return;
      for (std::size_t i = data.begin_of(row); i < data.end_of(row); ++i)
        entities.node_sets[set].push_back(static_cast<std::int32_t>(data.connectivity[i]));
    });
  return entities;
}

Soup surface_of(const VtkData& data, const std::string& where) {
  Soup soup;
  soup.points = data.points;
  std::vector<std::pair<const VtkArray*, bool>> arrays;  // and whether it is a mark
  for (const VtkArray& array : data.cell_arrays) {
    std::set<double> values;
    if (names_groups(array, values)) arrays.emplace_back(&array, values == std::set<double>{0, 1});
  }
  for (std::size_t cell = 0; cell < data.types.size(); ++cell) {
    if (shape_of(data.types[cell])->solid != nullptr) {
      refuse_geometry(where, "the file has volume elements",
                      "give it as [volume_mesh], or extract its surface");
    }
    Names names;
    for (const auto& [array, is_mark] : arrays) {
      names.push_back(label_of(*array, cell));
      if (is_mark && array->values[cell] != 0) names.push_back(array->name);
    }
    add_polygons(soup, data, cell, names);
  }
  return soup;
}

}  // namespace palpate::mesher
