// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/vtkhdf/vtkhdf.hpp"

#include <cmath>
#include <set>

#include "format/artifact.hpp"
#include "format/error.hpp"
#include "format/hdf5_file.hpp"

namespace palpate::vtkhdf {
namespace {

class GridChecks {
 public:
  GridChecks(const std::filesystem::path& path, const Grid& grid)
      : path_(path.string()), grid_(grid) {}

  void all() const {
    points();
    cells();
    arrays("PointData", grid_.point_data, grid_.points.size());
    arrays("CellData", grid_.cell_data, grid_.types.size());
  }

 private:
  void require(bool holds, const std::string& where, const std::string& problem) const {
    if (holds) return;
    throw Error(ErrorKind::Internal, path_ + ":/VTKHDF/" + where, problem,
                "nothing was written; report this as a defect of palpate");
  }

  void points() const {
    for (const Vec3& point : grid_.points) {
      for (const double x : point) require(std::isfinite(x), "Points", "a point is not finite");
    }
  }

  void cells() const {
    const auto& offsets = grid_.offsets;
    require(offsets.size() == grid_.types.size() + 1, "Offsets", "is not one row more than Types");
    require(offsets.front() == 0, "Offsets", "does not begin at 0");
    for (std::size_t cell = 0; cell < grid_.types.size(); ++cell) {
      const bool triangle = grid_.types[cell] == static_cast<std::uint8_t>(CellType::Triangle);
      const bool tetrahedron =
          grid_.types[cell] == static_cast<std::uint8_t>(CellType::Tetrahedron);
      require(triangle || tetrahedron, "Types", "holds an unknown cell type");
      require(offsets[cell + 1] - offsets[cell] == (triangle ? 3 : 4), "Offsets",
              "a cell has not the number of points of its type");
    }
    require(offsets.back() == static_cast<std::int64_t>(grid_.connectivity.size()), "Offsets",
            "does not end at the size of Connectivity");
    const auto limit = static_cast<std::int64_t>(grid_.points.size());
    for (const std::int64_t point : grid_.connectivity) {
      require(point >= 0 && point < limit, "Connectivity", "names a point that does not exist");
    }
  }

  void arrays(const std::string& group, const std::vector<DataArray>& arrays,
              std::size_t rows) const {
    std::set<std::string> names;
    for (const DataArray& array : arrays) {
      const std::string where = group + "/" + array.name;
      const bool nameable = !array.name.empty() && array.name.find('/') == std::string::npos;
      require(nameable && names.insert(array.name).second, where, "is no name or is there twice");
      const std::size_t found = std::visit([](const auto& v) { return v.size(); }, array.values);
      require(found == rows, where,
              "has " + std::to_string(found) + " rows, " + std::to_string(rows) + " expected");
    }
  }

  std::string path_;
  const Grid& grid_;
};

void write_count(hdf5::Writer& writer, const std::string& name, std::size_t count,
                 const std::string& description) {
  writer.dataset("/VTKHDF/" + name, std::vector<std::int64_t>{static_cast<std::int64_t>(count)},
                 {"1", description});
}

void write_arrays(hdf5::Writer& writer, const std::string& group,
                  const std::vector<DataArray>& arrays, const std::string& description) {
  writer.group(group, description);
  for (const DataArray& array : arrays) {
    std::visit(
        [&](const auto& values) {
          writer.dataset(group + "/" + array.name, values, {array.units, array.description});
        },
        array.values);
  }
}

}  // namespace

// [VTK file formats, "HDF5 file formats": UnstructuredGrid, version 1.0]. The counts are arrays
// with one entry per partition; here there is one partition.
void write_vtkhdf(const std::filesystem::path& path, const Grid& grid) {
  GridChecks(path, grid).all();
  hdf5::Writer writer(path);
  writer.set_text("/", "creator", creator_text());
  writer.set_text("/", "description", grid.description);
  writer.group("/VTKHDF", grid.description);
  writer.set_integers("/VTKHDF", "Version", {1, 0});
  writer.set_ascii("/VTKHDF", "Type", "UnstructuredGrid");
  write_count(writer, "NumberOfPoints", grid.points.size(), "Points of the partition.");
  write_count(writer, "NumberOfCells", grid.types.size(), "Cells of the partition.");
  write_count(writer, "NumberOfConnectivityIds", grid.connectivity.size(),
              "Point indices of the partition.");
  writer.dataset("/VTKHDF/Points", grid.points, {"m", "Position of each point."});
  writer.dataset("/VTKHDF/Connectivity", grid.connectivity, {"1", "Points of all cells."});
  writer.dataset("/VTKHDF/Offsets", grid.offsets, {"1", "Where each cell begins."});
  writer.dataset("/VTKHDF/Types", grid.types, {"1", "Cell types of VTK."});
  write_arrays(writer, "/VTKHDF/PointData", grid.point_data, "One value per point.");
  write_arrays(writer, "/VTKHDF/CellData", grid.cell_data, "One value per cell.");
  write_provenance(writer, grid.provenance);
  writer.commit();
}

}  // namespace palpate::vtkhdf
