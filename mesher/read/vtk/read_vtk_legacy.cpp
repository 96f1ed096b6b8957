// SPDX-License-Identifier: AGPL-3.0-or-later
// [VTK file formats, "Simple legacy formats"]; what version 5.1 changes is in the header of
// vtkDataWriter: offsets and connectivity as two arrays.
#include "mesher/read/vtk/read_vtk_legacy.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "mesher/geometry/text.hpp"
#include "mesher/read/file/scanner.hpp"

namespace palpate::mesher {
namespace {

constexpr std::size_t kMostComponents = 1000;

struct LegacyType {
  const char* name;
  std::size_t size;
  bool is_integral;
  double (*decode)(std::string_view, bool);
};
template <class Number>
double decoded(std::string_view bytes, bool swapped) {
  return static_cast<double>(Scanner::decoded<Number>(bytes, swapped));
}
constexpr LegacyType kLegacyTypes[] = {{"char", 1, true, decoded<std::int8_t>},
                                       {"signed_char", 1, true, decoded<std::int8_t>},
                                       {"unsigned_char", 1, true, decoded<std::uint8_t>},
                                       {"short", 2, true, decoded<std::int16_t>},
                                       {"unsigned_short", 2, true, decoded<std::uint16_t>},
                                       {"int", 4, true, decoded<std::int32_t>},
                                       {"unsigned_int", 4, true, decoded<std::uint32_t>},
                                       {"long", 8, true, decoded<std::int64_t>},
                                       {"unsigned_long", 8, true, decoded<std::uint64_t>},
                                       {"vtktypeint8", 1, true, decoded<std::int8_t>},
                                       {"vtktypeuint8", 1, true, decoded<std::uint8_t>},
                                       {"vtktypeint16", 2, true, decoded<std::int16_t>},
                                       {"vtktypeuint16", 2, true, decoded<std::uint16_t>},
                                       {"vtktypeint32", 4, true, decoded<std::int32_t>},
                                       {"vtktypeuint32", 4, true, decoded<std::uint32_t>},
                                       {"vtktypeint64", 8, true, decoded<std::int64_t>},
                                       {"vtktypeuint64", 8, true, decoded<std::uint64_t>},
                                       {"vtkidtype", 4, true, decoded<std::int32_t>},
                                       {"float", 4, false, decoded<float>},
                                       {"double", 8, false, decoded<double>}};
constexpr const char* kInt = "int";

/// Spaces and other letters in names are written as %20.
std::string unescaped(std::string_view name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto digit = [](char c) {
      return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    if (name[i] == '%' && i + 2 < name.size() && digit(name[i + 1]) >= 0 &&
        digit(name[i + 2]) >= 0) {
      text += static_cast<char>(16 * digit(name[i + 1]) + digit(name[i + 2]));
      i += 2;
    } else {
      text += name[i];
    }
  }
  return text;
}

class LegacyReader {
 public:
  LegacyReader(std::string_view bytes, const std::string& file)
      : scanner_(bytes, file), file_(file) {}

  VtkData read() {
    header();
    while (!scanner_.peek().empty()) section(lower(std::string(scanner_.word())));
    if (data_.types.size() != data_.offsets.size()) {
      scanner_.refuse(
          text("CELL_TYPES names ", data_.types.size(), " cells, CELLS ", data_.offsets.size()));
    }
    check_cells(data_, file_);
    return std::move(data_);
  }

 private:
  void header() {
    const std::string_view first = scanner_.required_line("# vtk DataFile Version");
    if (first.substr(0, 14) != "# vtk DataFile") {
      scanner_.refuse("the file does not begin with '# vtk DataFile'", "export it as VTK");
    }
    scanner_.required_line("a title");
    const std::string kind = lower(std::string(scanner_.required_line("ASCII or BINARY")));
    is_binary_ = kind == "binary";
    if (!is_binary_ && kind != "ascii") scanner_.refuse("neither ASCII nor BINARY");
  }

  void section(const std::string& keyword) {
    if (keyword == "dataset") {
      const std::string kind = lower(std::string(scanner_.word()));
      is_surface_ = kind == "polydata";
      if (!is_surface_ && kind != "unstructured_grid") {
        scanner_.refuse(text("a data set of the kind ", kind),
                        "save it as UNSTRUCTURED_GRID or POLYDATA");
      }
    } else if (keyword == "points") {
      points();
    } else if (keyword == "cells") {
      cells(0);
    } else if (keyword == "vertices" && is_surface_) {
      cells(VtkPolyVertex);
    } else if (keyword == "lines" && is_surface_) {
      cells(VtkPolyLine);
    } else if (keyword == "polygons" && is_surface_) {
      cells(VtkPolygon);
    } else if (keyword == "triangle_strips" && is_surface_) {
      cells(VtkStrip);
    } else if (keyword == "cell_types") {
      const std::size_t count = scanner_.count("the number of cell types", 1);
      for (const double type : numbers(kInt, count))
        data_.types.push_back(type >= 0 && type < 256 ? static_cast<int>(type) : 255);
    } else if (keyword == "cell_data" || keyword == "point_data") {
      rows_ =
          static_cast<std::size_t>(std::max<std::int64_t>(scanner_.integer("a number of rows"), 0));
      arrays_ = keyword == "cell_data" ? &data_.cell_arrays : &data_.point_arrays;
      const std::size_t wanted =
          keyword == "cell_data" ? data_.offsets.size() : data_.points.size();
      if (rows_ != wanted) {
        scanner_.refuse(text(keyword, " has ", rows_, " rows, ", wanted, " expected"));
      }
    } else if (keyword == "metadata") {
      scanner_.line();
      for (auto line = scanner_.line(); line && !line->empty();) line = scanner_.line();
    } else {
      attribute(keyword);
    }
  }

  void attribute(const std::string& keyword) {
    if (keyword == "field") {
      scanner_.word();
      const std::size_t count = scanner_.count("the number of arrays", 4);
      for (std::size_t i = 0; i < count; ++i) field_array();
    } else if (keyword == "scalars") {
      const std::string name = unescaped(scanner_.word()), type = type_name();
      std::size_t components = 1;
      if (const auto number = integer_of(scanner_.peek())) components = counted_components();
      if (lower(std::string(scanner_.peek())) == "lookup_table") {
        scanner_.word();
        scanner_.word();
      }
      add_array(name, type, components);
    } else if (keyword == "vectors" || keyword == "normals" || keyword == "tensors" ||
               keyword == "global_ids" || keyword == "pedigree_ids") {
      const std::string name = unescaped(scanner_.word()), type = type_name();
      add_array(name, type, keyword == "tensors" ? 9 : keyword.ends_with("ids") ? 1 : 3);
    } else if (keyword == "texture_coordinates") {
      const std::string name = unescaped(scanner_.word());
      const std::size_t components = counted_components();
      add_array(name, type_name(), components);
    } else if (keyword == "color_scalars") {
      scanner_.word();
      colours(rows_, counted_components());
    } else if (keyword == "lookup_table") {
      scanner_.word();
      colours(scanner_.count("the size of a lookup table", 4), 4);
    } else {
      scanner_.refuse(text("the keyword '", keyword.substr(0, 30), "'"));
    }
  }

  std::string type_name() { return lower(std::string(scanner_.word())); }
  std::size_t counted_components() {
    const std::int64_t found = scanner_.integer("a number of components");
    if (found < 1 || found > static_cast<std::int64_t>(kMostComponents)) {
      scanner_.refuse(text(found, " components"));
    }
    return static_cast<std::size_t>(found);
  }

  /// Bytes in a binary file, fractions in a text: not kept.
  void colours(std::size_t rows, std::size_t components) {
    numbers(is_binary_ ? "unsigned_char" : "float", rows * components);
  }

  const LegacyType& type_of(const std::string& name) const {
    const auto found = std::find_if(std::begin(kLegacyTypes), std::end(kLegacyTypes),
                                    [&](const LegacyType& type) { return type.name == name; });
    if (found == std::end(kLegacyTypes))
      scanner_.refuse(text("the type '", name.substr(0, 30), "'"));
    return *found;
  }

  /// Binary numbers are big-endian and begin on the next line.
  std::vector<double> numbers(const std::string& type_name, std::size_t count) {
    const LegacyType& type = type_of(type_name);
    scanner_.checked_count(static_cast<std::int64_t>(count), "the size of an array",
                           is_binary_ ? type.size : 1);
    std::vector<double> found;
    found.reserve(count);
    if (!is_binary_) {
      for (std::size_t i = 0; i < count; ++i) {
        const auto number = real_of(scanner_.word());
        if (!number) scanner_.refuse("a word that is no number in an array");
        found.push_back(*number);
      }
      return found;
    }
    scanner_.line();
    const std::string_view bytes = scanner_.raw(count * type.size, "an array");
    for (std::size_t i = 0; i < count; ++i)
      found.push_back(type.decode(bytes.substr(i * type.size, type.size), true));
    return found;
  }

  void points() {
    if (!data_.points.empty()) scanner_.refuse("POINTS for the second time");
    const std::size_t count = scanner_.count("the number of points", 3);
    const std::vector<double> x = numbers(type_name(), 3 * count);
    for (std::size_t i = 0; i < count; ++i)
      data_.points.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
  }

  std::int64_t whole(double number) const {
    if (!(std::abs(number) < 9e15)) scanner_.refuse(text("the index ", number));
    return static_cast<std::int64_t>(number);
  }

  /// @param type of every cell; 0 where CELL_TYPES names them
  void cells(int type) {
    const std::size_t first = scanner_.count("the number of cells", 1);
    const std::size_t second = scanner_.count("the size of the cells", 1);
    const std::size_t before = data_.offsets.size();
    lower(std::string(scanner_.peek())) == "offsets" ? split_cells(first, second)
                                                     : joined_cells(first, second);
    if (type != 0) data_.types.resize(data_.types.size() + data_.offsets.size() - before, type);
  }

  /// Up to version 4.2: the number of points, then the points, of each cell.
  void joined_cells(std::size_t count, std::size_t size) {
    const std::vector<double> list = numbers(kInt, size);
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < count; ++cell) {
      const std::int64_t points = at < size ? whole(list[at++]) : -1;
      if (points < 0 || static_cast<std::size_t>(points) > size - at) {
        scanner_.refuse(text("cell ", cell, " does not fit into ", size, " numbers"));
      }
      for (std::int64_t k = 0; k < points; ++k) data_.connectivity.push_back(whole(list[at++]));
      data_.offsets.push_back(static_cast<std::int64_t>(data_.connectivity.size()));
    }
    if (at != size) scanner_.refuse(text("the cells have ", at, " numbers, ", size, " announced"));
  }

  /// From version 5: `offsets` rows, one more than cells, then `size` points.
  void split_cells(std::size_t offsets, std::size_t size) {
    scanner_.word();
    const auto before = static_cast<std::int64_t>(data_.connectivity.size());
    const std::vector<double> rows = numbers(type_name(), offsets);
    for (std::size_t i = 1; i < rows.size(); ++i) data_.offsets.push_back(before + whole(rows[i]));
    if (lower(std::string(scanner_.word())) != "connectivity") {
      scanner_.refuse("OFFSETS without CONNECTIVITY");
    }
    for (const double point : numbers(type_name(), size))
      data_.connectivity.push_back(whole(point));
  }

  void add_array(const std::string& name, const std::string& type, std::size_t components) {
    if (arrays_ == nullptr) scanner_.refuse(text("'", name, "' before POINT_DATA or CELL_DATA"));
    arrays_->push_back(
        vtk_array(name, components, type_of(type).is_integral, numbers(type, rows_ * components)));
  }

  /// Part of the whole data set where it precedes POINT_DATA and CELL_DATA. Strings are skipped.
  void field_array() {
    const std::string name = unescaped(scanner_.word());
    const std::size_t components = static_cast<std::size_t>(scanner_.checked_count(
        scanner_.integer("a number of components"), "the number of components", 1));
    const std::size_t rows = scanner_.count("the number of rows", 1);
    const std::string type = type_name();
    if (components > kMostComponents) scanner_.refuse(text(components, " components"));
    if (type == "string") {
      texts(name, rows * components);
    } else {
      std::vector<double> values = numbers(type, rows * components);
      if (arrays_ != nullptr && rows == rows_) {
        arrays_->push_back(
            vtk_array(name, components, type_of(type).is_integral, std::move(values)));
      }
    }
    if (lower(std::string(scanner_.peek())) == "metadata")
      section(lower(std::string(scanner_.word())));
  }

  /// A line for each in a text file; in a binary one, the length in 1, 2, 4 or 8 bytes, of which
  /// the two highest bits tell which, then the letters.
  void texts(const std::string& name, std::size_t count) {
    std::vector<std::string> found;
    scanner_.line();
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_binary_) {
        found.push_back(unescaped(scanner_.required_line("a string")));
        continue;
      }
      const auto first = scanner_.binary<std::uint8_t>("a string");
      std::uint64_t length = first & 63U;
      for (int more = (1 << (3 - (first >> 6U))) - 1; more > 0; --more)
        length = length << 8U | scanner_.binary<std::uint8_t>("a string");
      if (length > scanner_.bytes_left()) scanner_.refuse("a string longer than the file");
      found.emplace_back(scanner_.raw(length, "a string"));
    }
    if (arrays_ == nullptr) data_.texts[name] = std::move(found);
  }

  Scanner scanner_;
  std::string file_;
  bool is_binary_ = false, is_surface_ = false;
  std::size_t rows_ = 0;
  std::vector<VtkArray>* arrays_ = nullptr;  ///< where the next arrays belong
  VtkData data_;
};

}  // namespace

VtkData read_vtk_legacy(std::string_view bytes, const std::string& file) {
  return LegacyReader(bytes, file).read();
}

}  // namespace palpate::mesher
