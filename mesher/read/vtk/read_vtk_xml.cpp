// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/vtk/read_vtk_xml.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/file/inflate.hpp"
#include "mesher/read/file/scanner.hpp"
#include "mesher/read/file/xml.hpp"
#include "mesher/read/vtk/data_array.hpp"

namespace palpate::mesher {
namespace {

/// The XML before the appended data, closed again, and the data behind their underscore.
struct Halves {
  std::string xml;
  std::string_view appended;
};

Halves divided(std::string_view bytes) {
  const std::size_t tag = bytes.find("<AppendedData");
  if (tag == std::string_view::npos) return {std::string(bytes), {}};
  const std::size_t mark = bytes.find('_', std::min(bytes.find('>', tag), bytes.size()));
  std::string xml(bytes.substr(
      0, bytes.find('>', tag) == std::string_view::npos ? bytes.size() : bytes.find('>', tag) + 1));
  xml += "</AppendedData></VTKFile>";
  if (mark == std::string_view::npos) return {xml, {}};
  return {xml, bytes.substr(mark + 1)};
}

class XmlReader {
 public:
  XmlReader(std::string_view bytes, const std::string& file)
      : halves_(divided(bytes)), xml_(halves_.xml, file), largest_(most_inflated(bytes.size())) {}

  VtkData read() {
    const pugi::xml_node root = xml_.document().child("VTKFile");
    if (!root) xml_.refuse({}, "the file has no VTKFile element");
    const std::string type = root.attribute("type").value();
    if (type != "UnstructuredGrid" && type != "PolyData") {
      xml_.refuse(root, text("a VTK file of type '", type, "'"),
                  "save it as UnstructuredGrid (.vtu) or PolyData (.vtp), in one file");
    }
    set_encoding(root);
    const pugi::xml_node grid = root.child(type.c_str());
    for (const pugi::xml_node piece : grid.children("Piece"))
      type == "PolyData" ? add_surface(piece) : add_cells(piece);
    for (const pugi::xml_node array : grid.child("FieldData").children()) add_text(array);
    check_cells(data_, xml_.file());
    return std::move(data_);
  }

 private:
  void set_encoding(pugi::xml_node root) {
    encoding_.is_swapped = root.attribute("byte_order").value() == std::string("BigEndian");
    encoding_.header_bytes = root.attribute("header_type").value() == std::string("UInt64") ? 8 : 4;
    const std::string compressor = root.attribute("compressor").value();
    encoding_.is_compressed = !compressor.empty();
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
      xml_.refuse(root, text("arrays compressed by ", compressor),
                  "save it with zlib or without compression");
    }
    const pugi::xml_node appended = root.child("AppendedData");
    encoding_.appended_is_base64 = appended.attribute("encoding").value() == std::string("base64");
    encoding_.appended = halves_.appended;
    if (encoding_.appended_is_base64)
      encoding_.appended =
          encoding_.appended.substr(0, encoding_.appended.find_first_of(" \t\r\n<"));
  }

  std::string place(pugi::xml_node array) const {
    return text(xml_.where(array), ": ", array.attribute("Name").value());
  }

  std::size_t count(pugi::xml_node piece, const char* name, std::size_t otherwise) const {
    const pugi::xml_attribute attribute = piece.attribute(name);
    if (!attribute) return otherwise;
    const auto number = integer_of(attribute.value());
    if (!number || *number < 0 || static_cast<std::uint64_t>(*number) > largest_) {
      xml_.refuse(piece, text(name, " is '", attribute.value(), "'"));
    }
    return static_cast<std::size_t>(*number);
  }

  std::vector<double> numbers(pugi::xml_node array, std::optional<std::size_t> wanted) const {
    VtkArrayText found{array.attribute("type").value(), array.attribute("format").value(),
                       array.child_value(), 0};
    // Base64 may have blanks around it.
    if (found.format == "binary") found.text = trimmed_text(found.text);
    if (found.format == "appended") found.offset = count(array, "offset", 0);
    return numbers_of(found, encoding_, wanted, place(array));
  }

  std::vector<std::int64_t> integers(pugi::xml_node parent, const char* name,
                                     std::size_t wanted) const {
    const pugi::xml_node array = parent.find_child_by_attribute("DataArray", "Name", name);
    if (!array) xml_.refuse(parent, text("there is no array '", name, "'"));
    std::vector<std::int64_t> found;
    found.reserve(wanted);
    for (const double number : numbers(array, wanted)) {
      if (!(std::abs(number) < 9e15)) xml_.refuse(array, text("the number ", number));
      found.push_back(static_cast<std::int64_t>(number));
    }
    return found;
  }

  /// @return the number of points before
  std::int64_t add_points(pugi::xml_node piece) {
    const std::size_t before = data_.points.size();
    const std::size_t points = count(piece, "NumberOfPoints", 0);
    if (points > 0) {
      const pugi::xml_node array = piece.child("Points").child("DataArray");
      if (!array) xml_.refuse(piece, "a piece without points");
      const std::vector<double> x = numbers(array, 3 * points);
      for (std::size_t i = 0; i < points; ++i)
        data_.points.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
    }
    add_arrays(piece.child("PointData"), before, points, data_.point_arrays);
    return static_cast<std::int64_t>(before);
  }

  void add_connectivity(pugi::xml_node cells, std::size_t number, std::int64_t first_point) {
    const std::vector<std::int64_t> ends = integers(cells, "offsets", number);
    const auto before = static_cast<std::int64_t>(data_.connectivity.size());
    for (const std::int64_t end : ends) data_.offsets.push_back(before + end);
    const std::int64_t size = ends.empty() ? 0 : ends.back();
    if (size < 0 || static_cast<std::uint64_t>(size) > largest_) {
      xml_.refuse(cells, text("the last offset is ", size));
    }
    for (const std::int64_t point : integers(cells, "connectivity", static_cast<std::size_t>(size)))
      data_.connectivity.push_back(point < 0 ? point : point + first_point);
  }

  void add_cells(pugi::xml_node piece) {
    const std::int64_t first_point = add_points(piece);
    const std::size_t before = data_.types.size(), cells = count(piece, "NumberOfCells", 0);
    if (cells > 0) {
      const pugi::xml_node node = piece.child("Cells");
      for (const std::int64_t type : integers(node, "types", cells))
        data_.types.push_back(static_cast<int>(std::clamp<std::int64_t>(type, 0, 255)));
      add_connectivity(node, cells, first_point);
    }
    add_arrays(piece.child("CellData"), before, cells, data_.cell_arrays);
  }

  void add_surface(pugi::xml_node piece) {
    const std::int64_t first_point = add_points(piece);
    const std::size_t before = data_.types.size();
    struct Kind {
      const char *count, *name;
      int type;
    };
    // In the order of the cell data.
    for (const Kind& kind :
         {Kind{"NumberOfVerts", "Verts", VtkPolyVertex},
          Kind{"NumberOfLines", "Lines", VtkPolyLine}, Kind{"NumberOfPolys", "Polys", VtkPolygon},
          Kind{"NumberOfStrips", "Strips", VtkStrip}}) {
      const std::size_t cells = count(piece, kind.count, 0);
      if (cells == 0) continue;
      add_connectivity(piece.child(kind.name), cells, first_point);
      data_.types.resize(data_.types.size() + cells, kind.type);
    }
    add_arrays(piece.child("CellData"), before, data_.types.size() - before, data_.cell_arrays);
  }

  /// An array that a piece lacks is dropped.
  void add_arrays(pugi::xml_node parent, std::size_t before, std::size_t rows,
                  std::vector<VtkArray>& arrays) {
    for (const pugi::xml_node node : parent.children("DataArray")) {
      const std::string type = node.attribute("type").value();
      if (type == "String" || type == "Bit") continue;
      const std::size_t components = count(node, "NumberOfComponents", 1);
      if (components == 0 || components > 1000) continue;
      VtkArray array =
          vtk_array(node.attribute("Name").value(), components,
                    type.find("Int") != std::string::npos, numbers(node, rows * components));
      const auto known = std::find_if(arrays.begin(), arrays.end(), [&](const VtkArray& other) {
        return other.name == array.name && other.components == components;
      });
      if (known != arrays.end()) {
        known->is_integral = known->is_integral && array.is_integral;
        known->values.insert(known->values.end(), array.values.begin(), array.values.end());
      } else if (before == 0) {
        arrays.push_back(std::move(array));
      }
    }
    std::erase_if(arrays, [&](const VtkArray& array) {
      return array.values.size() != (before + rows) * array.components;
    });
  }

  /// Strings are lists of characters, each string with a zero behind it.
  void add_text(pugi::xml_node array) {
    if (array.attribute("type").value() != std::string("String")) return;
    std::vector<std::string> lines(1);
    for (const double letter : numbers(array, std::nullopt)) {
      if (letter == 0) lines.emplace_back();
      if (letter != 0 && letter >= -128 && letter < 256)
        lines.back() += static_cast<char>(static_cast<int>(letter));
    }
    lines.pop_back();
    data_.texts[array.attribute("Name").value()] = std::move(lines);
  }

  Halves halves_;
  XmlFile xml_;
  std::size_t largest_;  ///< no count can be above it
  VtkEncoding encoding_;
  VtkData data_;
};

}  // namespace

VtkData read_vtk_xml(std::string_view bytes, const std::string& file) {
  return XmlReader(bytes, file).read();
}

}  // namespace palpate::mesher
