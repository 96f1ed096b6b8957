// SPDX-License-Identifier: AGPL-3.0-or-later
// [Teem, "Definition of NRRD file format"]
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "format/error.hpp"
#include "format/text.hpp"
#include "mesher/read/file/inflate.hpp"
#include "mesher/read/image/label_image.hpp"
#include "mesher/read/image/voxels.hpp"

namespace palpate::mesher {
namespace {

constexpr std::pair<const char*, VoxelType> kTypes[] = {
    {"signed char", VoxelType::Int8},    {"int8", VoxelType::Int8},
    {"int8_t", VoxelType::Int8},         {"uchar", VoxelType::UInt8},
    {"unsigned char", VoxelType::UInt8}, {"uint8", VoxelType::UInt8},
    {"uint8_t", VoxelType::UInt8},       {"short", VoxelType::Int16},
    {"int16", VoxelType::Int16},         {"int16_t", VoxelType::Int16},
    {"ushort", VoxelType::UInt16},       {"unsigned short", VoxelType::UInt16},
    {"uint16", VoxelType::UInt16},       {"uint16_t", VoxelType::UInt16},
    {"int", VoxelType::Int32},           {"int32", VoxelType::Int32},
    {"int32_t", VoxelType::Int32},       {"uint", VoxelType::UInt32},
    {"unsigned int", VoxelType::UInt32}, {"uint32", VoxelType::UInt32},
    {"uint32_t", VoxelType::UInt32},     {"longlong", VoxelType::Int64},
    {"int64", VoxelType::Int64},         {"int64_t", VoxelType::Int64},
    {"uint64", VoxelType::UInt64},       {"uint64_t", VoxelType::UInt64},
    {"float", VoxelType::Float},         {"double", VoxelType::Double}};

class NrrdReader {
 public:
  NrrdReader(std::string_view bytes, const std::filesystem::path& path)
      : scanner_(bytes, path.string()), path_(path), bytes_(bytes) {}

  LabelImage read(double unit) {
    header();
    LabelImage image;
    sizes(image);
    place(image);
    scale_image(image, unit > 0 ? unit : stated_unit(), path_.string());
    voxels(image);
    return image;
  }

 private:
  void header() {
    if (!scanner_.required_line("NRRD").starts_with("NRRD000")) {
      scanner_.refuse("the file does not begin with NRRD000", "export it as NRRD");
    }
    while (const auto line = scanner_.line()) {
      if (line->empty()) return;
      if (line->front() == '#' || line->find(":=") != std::string_view::npos) continue;
      const std::size_t colon = line->find(": ");
      if (colon == std::string_view::npos) scanner_.refuse("a line of the header without ': '");
      fields_[lower(std::string(line->substr(0, colon)))] = trimmed(line->substr(colon + 2));
    }
  }
  std::string field(const std::string& name) const {
    const auto found = fields_.find(name);
    return found == fields_.end() ? std::string() : found->second;
  }
  [[noreturn]] void refuse(const std::string& problem,
                           const std::string& remedy = kDamagedFile) const {
    refuse_geometry(path_.string(), problem, remedy);
  }

  void sizes(LabelImage& image) {
    if (field("dimension") != "3") {
      refuse("dimension is '" + field("dimension") + "'",
             "give one label for each voxel: dimension 3");
    }
    const std::string list = field("sizes");
    Fields words(list, scanner_);
    for (std::size_t& size : image.size) {
      const std::int64_t found = words.integer("a size");
      if (found < 1 || found > 100000) refuse(text("an axis of ", found, " voxels"));
      size = static_cast<std::size_t>(found);
    }
  }

  /// "(1,0,0)"
  Vec3 vector(std::string_view word) const {
    if (word.size() < 2 || word.front() != '(' || word.back() != ')') {
      refuse(text("'", word.substr(0, 30), "' where a vector is expected"));
    }
    Fields parts(word.substr(1, word.size() - 2), scanner_, ',');
    Vec3 x{};
    for (double& component : x) component = parts.real("a component");
    return x;
  }

  void place(LabelImage& image) const {
    if (field("space directions").empty() || field("space origin").empty()) {
      refuse("the header gives no space directions and origin",
             "save it with its orientation, as 3D Slicer does");
    }
    std::string_view rest = fields_.at("space directions");
    for (Vec3& step : image.step) {
      const std::size_t end = std::min(rest.find(')'), rest.size() - 1);
      step = vector(trimmed(rest.substr(0, end + 1)));
      rest = trimmed(rest.substr(end + 1));
      if (rest.empty() && &step != &image.step.back()) refuse("fewer than three space directions");
    }
    image.origin = vector(fields_.at("space origin"));
    const std::string space = lower(field("space"));
    if (space == "left-anterior-superior" || space == "las" || space == "3d-left-handed") {
      for (Vec3& step : image.step) step[0] = -step[0];
      image.origin[0] = -image.origin[0];
    }
  }

  double stated_unit() const {
    const std::string units = field("space units");
    for (const auto& [symbol, value] :
         {std::pair("\"mm\"", 1e-3), {"\"m\"", 1.0}, {"\"cm\"", 1e-2}, {"\"um\"", 1e-6}})
      if (units.starts_with(symbol)) return value;
    return 0;
  }

  VoxelType type() const {
    const std::string name = field("type");
    const auto* found = std::find_if(std::begin(kTypes), std::end(kTypes),
                                     [&](const auto& entry) { return entry.first == name; });
    if (found == std::end(kTypes))
      refuse("voxels of type '" + name + "'", "save the labels as integers");
    return found->second;
  }

  /// The voxels behind the header or in a file beside it.
  std::string data() const {
    std::string file = field("data file");
    if (file.empty()) file = field("datafile");
    if (file.empty()) return std::string(bytes_.substr(scanner_.position()));
    if (file.starts_with("LIST") || file.find('%') != std::string::npos) {
      refuse("the voxels are in several files", "save the image as one file");
    }
    return read_bytes(path_.parent_path() / file);
  }

  void voxels(LabelImage& image) const {
    const std::size_t count = image.size[0] * image.size[1] * image.size[2];
    const std::string encoding = lower(field("encoding"));
    std::string bytes = data();
    if (encoding == "ascii" || encoding == "text" || encoding == "txt") {
      Scanner words(bytes, path_.string());
      for (std::size_t voxel = 0; voxel < count; ++voxel)
        image.labels.push_back(label_of(words.real("a voxel"), voxel, path_.string()));
      return;
    }
    const std::size_t size = bytes_of(type());
    if (!(field("byte skip").empty() || field("byte skip") == "0") ||
        !(field("line skip").empty() || field("line skip") == "0")) {
      refuse("bytes or lines before the voxels are skipped",
             "save it without byte skip and line skip");
    }
    if (encoding == "gzip" || encoding == "gz") {
      bytes = inflate_exactly(bytes, count * size, path_.string());
    } else if (encoding != "raw") {
      refuse("the encoding '" + encoding + "'", "save it as raw, gzip or text");
    }
    if (bytes.size() < count * size) {
      refuse(text("the voxels have ", bytes.size(), " of ", count * size, " bytes"));
    }
    if (size > 1 && field("endian") != "little" && field("endian") != "big") {
      refuse("the header states no byte order (endian)");
    }
    const bool swapped = field("endian") == "big";
    image.labels.reserve(count);
    for (std::size_t voxel = 0; voxel < count; ++voxel)
      image.labels.push_back(
          label_of(voxel_at(std::string_view(bytes).substr(voxel * size, size), type(), swapped),
                   voxel, path_.string()));
  }

  Scanner scanner_;
  std::filesystem::path path_;
  std::string_view bytes_;
  std::map<std::string, std::string> fields_;
};

}  // namespace

LabelImage read_nrrd(std::string_view bytes, double unit, const std::filesystem::path& path) {
  return NrrdReader(bytes, path).read(unit);
}

}  // namespace palpate::mesher
