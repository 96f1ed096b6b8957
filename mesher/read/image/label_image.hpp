// SPDX-License-Identifier: AGPL-3.0-or-later
// Images whose voxels name what is there: segmentations.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::mesher {

struct LabelImage {
  std::array<std::size_t, 3> size{};  ///< voxels along each axis of the grid
  std::array<Vec3, 3> step{};         ///< m, from a voxel to the next along each axis
  Vec3 origin{};                      ///< m, centre of the first voxel
  std::vector<std::int32_t> labels;   ///< the first axis runs fastest; 0 is outside

  std::int32_t at(std::size_t i, std::size_t j, std::size_t k) const {
    return labels[i + size[0] * (j + size[1] * k)];
  }
  /// The centre of a voxel, or a point between voxels, in metres.
  Vec3 point(const Vec3& index) const {
    return origin + index[0] * step[0] + index[1] * step[1] + index[2] * step[2];
  }
};

/// The label of any point of an image. Voxels make steps of their boundary, so the label is that of
/// the largest membership: the indicator function of each label, interpolated trilinearly between
/// the centres of voxels. Its level set at one half cuts the corners of the steps off. Where two
/// memberships are equal, the smaller label wins. Outside the image all is 0.
class ImageLabels {
 public:
  /// @throws Error(Geometry) at `where` when the axes of the image do not span space.
  ImageLabels(LabelImage image, const std::string& where);

  std::int32_t label(const Vec3& point) const;
  const LabelImage& image() const { return image_; }

 private:
  LabelImage image_;
  std::array<Vec3, 3> inverse_{};  ///< rows: index = inverse (point - origin)
};

/// Reads NIfTI-1 (.nii, .nii.gz) and NRRD (.nrrd, .nhdr; raw, gzip or text) by the ending.
/// Coordinates are those that the header gives the voxels: sform, else qform, of NIfTI; space
/// directions and origin of NRRD. Those of a left-handed space are mirrored in its first axis.
/// @param unit m per unit of length of the header; 0: that which the header states
/// @throws Error(Geometry) for a header that contradicts itself or the size of the file, values
///   that are no integers, more than one value a voxel; Error(Configuration) where neither the
///   header nor the case states the unit.
LabelImage read_label_image(const std::filesystem::path& path, double unit);

/// The parts of it, from bytes.
LabelImage read_nifti(std::string_view bytes, double unit, const std::string& where);
/// Bytes that a header of NIfTI-1 announces, voxels included.
std::size_t nifti_file_size(std::string_view header, const std::string& where);
LabelImage read_nrrd(std::string_view bytes, double unit, const std::filesystem::path& path);

/// Steps and origin to metres.
/// @throws Error(Configuration) when the unit (m) is 0: unknown; Error(Geometry) for numbers that
///   are not finite.
void scale_image(LabelImage& image, double unit, const std::string& where);

}  // namespace palpate::mesher
