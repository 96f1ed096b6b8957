// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/read_ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "mesher/read/file/scanner.hpp"
#include "mesher/read/image/voxels.hpp"

namespace palpate::mesher {
namespace {

// Strips of whole models are the longest lists in use.
constexpr double kLongestList = 1e9;

struct Property {
  std::string name;
  VoxelType type = VoxelType::Float;
  bool is_list = false;
  VoxelType count_type = VoxelType::UInt8;

  bool is_real() const { return type == VoxelType::Float || type == VoxelType::Double; }
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

/// The values of one vertex or face: those of each property, in order.
using Row = std::vector<std::vector<double>>;

/// "#ff0000", or empty where there is none.
using Colour = std::string;

Colour colour_of(const PlyElement& element, const Row& row) {
  std::array<int, 3> level{-1, -1, -1};
  constexpr std::array<const char*, 3> kNames = {"red", "green", "blue"};
  for (std::size_t p = 0; p < row.size(); ++p) {
    const Property& property = element.properties[p];
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_this =
          property.name == kNames[k] || property.name == std::string("diffuse_") + kNames[k];
      if (!is_this || property.is_list) continue;
      const double value = row[p].front() * (property.is_real() ? 255 : 1);
      level[k] = static_cast<int>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
  }
  if (*std::min_element(level.begin(), level.end()) < 0) return {};
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", static_cast<unsigned>(level[0]),
                static_cast<unsigned>(level[1]), static_cast<unsigned>(level[2]));
  return text.data();
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& file) : scanner_(bytes, file) {}

  Soup read() {
    read_header();
    for (const PlyElement& element : elements_) {
      if (!is_binary_) scanner_.checked_count(count_of(element), element.name, 1);
      for (std::size_t i = 0; i < element.count; ++i) add(element, read_row(element));
    }
    name_faces();
    return std::move(soup_);
  }

 private:
  static std::int64_t count_of(const PlyElement& e) { return static_cast<std::int64_t>(e.count); }

  void read_header() {
    if (scanner_.required_line("ply") != "ply")
      scanner_.refuse("the file does not begin with 'ply'");
    bool has_format = false;
    for (;;) {
      Fields fields(scanner_.required_line("'end_header'"), scanner_);
      const std::string_view keyword = fields.next();
      if (keyword == "end_header") break;
      if (keyword == "format") has_format = read_format(fields);
      if (keyword == "element") read_element(fields);
      if (keyword == "property") read_property(fields);
    }
    if (!has_format) scanner_.refuse("the header has no format");
  }

  bool read_format(Fields& fields) {
    const std::string format(fields.next());
    is_binary_ = format != "ascii";
    if (is_binary_ && format != "binary_little_endian" && format != "binary_big_endian")
      scanner_.refuse("unknown format '" + format + "'");
    is_swapped_ =
        is_binary_ && (format == "binary_big_endian") != (std::endian::native == std::endian::big);
    return true;
  }

  void read_element(Fields& fields) {
    PlyElement element;
    element.name = fields.next();
    element.count = scanner_.checked_count(fields.integer("a number of elements"), element.name, 1);
    elements_.push_back(element);
  }

  void read_property(Fields& fields) {
    if (elements_.empty()) scanner_.refuse("a property before the first element");
    Property property;
    std::string_view type = fields.next();
    property.is_list = type == "list";
    if (property.is_list) {
      property.count_type = type_of(fields.next());
      type = fields.next();
    }
    property.type = type_of(type);
    property.name = fields.next();
    elements_.back().properties.push_back(property);
  }

  VoxelType type_of(std::string_view name) const {
    static const std::map<std::string_view, VoxelType> types = {
        {"char", VoxelType::Int8},     {"int8", VoxelType::Int8},     {"uchar", VoxelType::UInt8},
        {"uint8", VoxelType::UInt8},   {"short", VoxelType::Int16},   {"int16", VoxelType::Int16},
        {"ushort", VoxelType::UInt16}, {"uint16", VoxelType::UInt16}, {"int", VoxelType::Int32},
        {"int32", VoxelType::Int32},   {"uint", VoxelType::UInt32},   {"uint32", VoxelType::UInt32},
        {"float", VoxelType::Float},   {"float32", VoxelType::Float}, {"double", VoxelType::Double},
        {"float64", VoxelType::Double}};
    const auto found = types.find(name);
    if (found == types.end()) scanner_.refuse("unknown type '" + std::string(name) + "'");
    return found->second;
  }

  double read_number(VoxelType type, const std::string& what) {
    if (!is_binary_) return is_number_needed(what) ? scanner_.real(what) : skipped_number(what);
    const double value = voxel_at(scanner_.raw(bytes_of(type), what), type, is_swapped_);
    if (!std::isfinite(value) && is_number_needed(what)) scanner_.refuse(what + " is not finite");
    return std::isfinite(value) ? value : 0;
  }

  static bool is_number_needed(const std::string& name) {
    return name == "x" || name == "y" || name == "z" || name.starts_with("vertex_ind");
  }

  /// Programs write "nan" for a normal or a colour that they do not know.
  double skipped_number(const std::string& what) {
    const std::string_view word = scanner_.word();
    if (word.empty()) scanner_.refuse("the file ends where " + what + " is expected");
    const double value = real_of(word).value_or(0);
    return std::isfinite(value) ? value : 0;
  }

  Row read_row(const PlyElement& element) {
    Row row;
    for (const Property& p : element.properties) {
      std::size_t count = 1;
      if (p.is_list) {
        const double length = read_number(p.count_type, "the length of " + p.name);
        if (!(length >= 0 && length <= kLongestList))
          scanner_.refuse(text("a list of ", length, " entries"));
        const std::size_t smallest = is_binary_ ? bytes_of(p.type) : 1;
        count = scanner_.checked_count(static_cast<std::int64_t>(length), p.name, smallest);
      }
      std::vector<double>& values = row.emplace_back();
      for (std::size_t i = 0; i < count; ++i) values.push_back(read_number(p.type, p.name));
    }
    return row;
  }

  void add(const PlyElement& element, const Row& row) {
    if (element.name == "vertex") {
      soup_.points.push_back(position(element, row));
      point_colours_.push_back(colour_of(element, row));
    } else if (element.name == "face" || element.name == "tristrips") {
      if (element.name == "face") {
        add_face(corners_of(element, row), colour_of(element, row));
      } else {
        add_strips(element, row);
      }
    }
  }

  Vec3 position(const PlyElement& element, const Row& row) const {
    Vec3 x{};
    int found = 0;
    for (std::size_t p = 0; p < row.size(); ++p) {
      const std::string& name = element.properties[p].name;
      if (name.size() != 1 || name[0] < 'x' || name[0] > 'z' || row[p].size() != 1) continue;
      x[static_cast<std::size_t>(name[0] - 'x')] = row[p].front();
      ++found;
    }
    if (found != 3) scanner_.refuse("a vertex without x, y and z");
    return x;
  }

  const std::vector<double>& indices(const PlyElement& element, const Row& row) const {
    for (std::size_t p = 0; p < row.size(); ++p) {
      const Property& property = element.properties[p];
      if (property.is_list && property.name.starts_with("vertex_ind")) return row[p];
    }
    scanner_.refuse("a face without vertex_indices");
  }

  std::size_t point(double index) const {
    const auto points = static_cast<double>(soup_.points.size());
    if (!(index >= 0) || index >= points)
      scanner_.refuse(text("the index ", index, " of a face is none of the ", points, " vertices"));
    return static_cast<std::size_t>(index);
  }

  std::vector<std::size_t> corners_of(const PlyElement& element, const Row& row) const {
    std::vector<std::size_t> corners;
    for (const double index : indices(element, row)) corners.push_back(point(index));
    return corners;
  }

  void add_face(const std::vector<std::size_t>& corners, const Colour& colour) {
    soup_.polygons.push_back(corners);
    face_colours_.push_back(colour);
  }

  /// Each index makes a triangle with the two before it, turned every other time; -1 ends a strip.
  void add_strips(const PlyElement& element, const Row& row) {
    std::vector<std::size_t> strip;
    for (const double index : indices(element, row)) {
      if (index < 0) {
        strip.clear();
        continue;
      }
      strip.push_back(point(index));
      const std::size_t n = strip.size();
      if (n < 3) continue;
      std::vector<std::size_t> corners{strip[n - 3], strip[n - 2], strip[n - 1]};
      if (n % 2 == 0) std::swap(corners[0], corners[1]);
      const bool collapsed =
          corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2];
      if (!collapsed) add_face(corners, {});
    }
  }

  Colour colour_of_corners(const std::vector<std::size_t>& corners) const {
    std::map<Colour, std::size_t> votes;
    for (const std::size_t v : corners) ++votes[point_colours_[v]];
    for (const auto& [colour, count] : votes)
      if (2 * count > corners.size()) return colour;
    return {};
  }

  void name_faces() {
    std::map<Colour, std::size_t> known;
    bool any = false;
    for (std::size_t f = 0; f < soup_.polygons.size(); ++f) {
      Colour colour = face_colours_[f];
      if (colour.empty()) colour = colour_of_corners(soup_.polygons[f]);
      any = any || !colour.empty();
      const auto [entry, is_new] = known.emplace(colour, soup_.known_names.size());
      if (is_new) soup_.known_names.push_back(colour.empty() ? Names{} : Names{colour});
      soup_.names.push_back(entry->second);
    }
    if (any) return;
    soup_.names.clear();
    soup_.known_names.clear();
  }

  Scanner scanner_;
  bool is_binary_ = false, is_swapped_ = false;
  std::vector<PlyElement> elements_;
  std::vector<Colour> point_colours_, face_colours_;
  Soup soup_;
};

}  // namespace

Soup read_ply(std::string_view bytes, const std::string& file) {
  return PlyReader(bytes, file).read();
}

}  // namespace palpate::mesher
