// SPDX-License-Identifier: AGPL-3.0-or-later
// [NIfTI-1 data format, nifti1.h of the NIfTI data format working group]. The header is 348 bytes
// at fixed places: read here with bounds, so that damage ends in a refusal.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "format/error.hpp"
#include "mesher/read/image/label_image.hpp"
#include "mesher/read/image/voxels.hpp"

namespace palpate::mesher {
namespace {

constexpr std::size_t kHeader = 348;

class NiftiHeader {
 public:
  NiftiHeader(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {
    if (bytes.size() < kHeader) refuse("the file is shorter than a header of NIfTI");
    swapped_ = integer<std::int32_t>(0) != static_cast<std::int64_t>(kHeader);
    if (integer<std::int32_t>(0) != static_cast<std::int64_t>(kHeader)) {
      refuse("the file is not of NIfTI-1", "save it as NIfTI-1");
    }
    if (bytes.substr(344, 3) != "n+1") {
      refuse("the header and the voxels are in two files", "save it as one .nii file");
    }
    check_dimensions();
    find_type();
    const double offset = real(108);
    if (!(offset >= static_cast<double>(kHeader) && offset < 1e12)) {
      refuse(text("the voxels begin at byte ", offset));
    }
    offset_ = static_cast<std::size_t>(offset);
  }

  std::size_t voxels() const { return size_[0] * size_[1] * size_[2]; }
  std::size_t offset() const { return offset_; }
  std::size_t file_size() const { return offset_ + voxels() * bytes_of(type_); }
  const std::array<std::size_t, 3>& size() const { return size_; }
  VoxelType type() const { return type_; }
  bool swapped() const { return swapped_; }

  /// m per unit; nothing where the header does not state it.
  std::optional<double> unit() const {
    switch (bytes_[123] & 7) {
      case 1:
        return 1.0;
      case 2:
        return 1e-3;
      case 3:
        return 1e-6;
      default:
        return std::nullopt;
    }
  }
  double slope() const { return real(112); }
  double intercept() const { return real(116); }

  /// Steps and origin, in the unit of the header: by sform, else by qform.
  void place(LabelImage& image) const {
    if (integer<std::int16_t>(254) > 0) {
      for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          image.step[axis][row] = real(280 + 16 * row + 4 * axis);
        image.origin[row] = real(280 + 16 * row + 12);
      }
    } else if (integer<std::int16_t>(252) > 0) {
      place_by_quaternion(image);
    } else {
      refuse("the header gives no orientation (sform_code and qform_code are 0)",
             "set one of them, as 3D Slicer and nibabel do when they save");
    }
  }

 private:
  template <class Number>
  std::int64_t integer(std::size_t at) const {
    return Scanner::decoded<Number>(bytes_.substr(at, sizeof(Number)), swapped_);
  }
  double real(std::size_t at) const {
    return Scanner::decoded<float>(bytes_.substr(at, 4), swapped_);
  }
  [[noreturn]] void refuse(const std::string& problem,
                           const std::string& remedy = kDamagedFile) const {
    refuse_geometry(where_, problem, remedy);
  }

  void check_dimensions() {
    const std::int64_t dimensions = integer<std::int16_t>(40);
    if (dimensions < 3 || dimensions > 7) refuse(text("an image of ", dimensions, " dimensions"));
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions); ++i) {
      const std::int64_t size = integer<std::int16_t>(42 + 2 * i);
      if (size < 1) refuse(text("an axis of ", size, " voxels"));
      if (i < 3) size_[i] = static_cast<std::size_t>(size);
      if (i >= 3 && size != 1) {
        refuse("an image of several values a voxel", "give one label for each voxel");
      }
    }
  }

  void find_type() {
    constexpr std::pair<std::int64_t, VoxelType> types[] = {
        {256, VoxelType::Int8},   {2, VoxelType::UInt8},     {4, VoxelType::Int16},
        {512, VoxelType::UInt16}, {8, VoxelType::Int32},     {768, VoxelType::UInt32},
        {1024, VoxelType::Int64}, {1280, VoxelType::UInt64}, {16, VoxelType::Float},
        {64, VoxelType::Double}};
    const std::int64_t code = integer<std::int16_t>(70);
    const auto* found = std::find_if(std::begin(types), std::end(types),
                                     [&](const auto& type) { return type.first == code; });
    if (found == std::end(types)) {
      refuse(text("voxels of type ", code), "save the labels as integers");
    }
    type_ = found->second;
  }

  /// Rotation by the quaternion (a, b, c, d) of unit length, spacing, and a mirror in the third
  /// axis.
  void place_by_quaternion(LabelImage& image) const {
    const double b = real(256), c = real(260), d = real(264);
    const double a = std::sqrt(std::max(0.0, 1 - (b * b + c * c + d * d)));
    const std::array<Vec3, 3> columns{
        Vec3{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
        Vec3{2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
        Vec3{2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double mirror = axis == 2 && real(76) < 0 ? -1 : 1;
      image.step[axis] = mirror * real(80 + 4 * axis) * columns[axis];
      image.origin[axis] = real(268 + 4 * axis);
    }
  }

  std::string_view bytes_;
  const std::string& where_;
  bool swapped_ = false;
  std::array<std::size_t, 3> size_{};
  VoxelType type_ = VoxelType::UInt8;
  std::size_t offset_ = 0;
};

}  // namespace

std::size_t nifti_file_size(std::string_view header, const std::string& where) {
  return NiftiHeader(header, where).file_size();
}

LabelImage read_nifti(std::string_view bytes, double unit, const std::string& where) {
  const NiftiHeader header(bytes, where);
  if (bytes.size() < header.file_size()) {
    refuse_geometry(where,
                    text("the file has ", bytes.size(), " of ", header.file_size(), " bytes"),
                    kDamagedFile);
  }
  LabelImage image;
  image.size = header.size();
  header.place(image);
  scale_image(image, unit > 0 ? unit : header.unit().value_or(0), where);
  const std::size_t size = bytes_of(header.type());
  const bool is_scaled = header.slope() != 0 && std::isfinite(header.slope());
  image.labels.reserve(header.voxels());
  for (std::size_t voxel = 0; voxel < header.voxels(); ++voxel) {
    double value = voxel_at(bytes.substr(header.offset() + voxel * size, size), header.type(),
                            header.swapped());
    if (is_scaled) value = header.slope() * value + header.intercept();
    image.labels.push_back(label_of(value, voxel, where));
  }
  return image;
}

}  // namespace palpate::mesher
