// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/image/label_image.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "format/error.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/file/file.hpp"
#include "mesher/read/file/inflate.hpp"
#include "mesher/read/file/scanner.hpp"

namespace palpate::mesher {
namespace {

constexpr std::size_t kNiftiHeader = 348;

/// The bytes of a file of NIfTI, decompressed as far as its header announces.
std::string nifti_bytes(const std::filesystem::path& path) {
  const std::string where = path.string();
  std::string bytes = read_bytes(path);
  if (ending(path) != ".nii.gz") return bytes;
  const std::string header = inflate_exactly(bytes, kNiftiHeader + 4, where);
  return inflate_exactly(bytes, nifti_file_size(header, where), where);
}

}  // namespace

ImageLabels::ImageLabels(LabelImage image, const std::string& where) : image_(std::move(image)) {
  const auto& [a, b, c] = image_.step;
  const double volume = dot(a, cross(b, c));
  if (!(std::abs(volume) > 1e-9 * norm(a) * norm(b) * norm(c))) {
    refuse_geometry(where, "the axes of the image lie in one plane",
                    "correct the orientation in its header");
  }
  inverse_ = {(1 / volume) * cross(b, c), (1 / volume) * cross(c, a), (1 / volume) * cross(a, b)};
}

std::int32_t ImageLabels::label(const Vec3& point) const {
  std::array<std::int64_t, 3> low{};
  Vec3 part{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double index = dot(inverse_[axis], point - image_.origin);
    if (!(index > -1 && index < static_cast<double>(image_.size[axis]))) return 0;
    low[axis] = static_cast<std::int64_t>(std::floor(index));
    part[axis] = index - std::floor(index);
  }
  std::array<std::pair<std::int32_t, double>, 8> memberships{};
  std::size_t known = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<std::size_t, 3> voxel{};
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t step = corner >> axis & 1U;
      weight *= step == 1 ? part[axis] : 1 - part[axis];
      const std::int64_t i = low[axis] + step;
      inside = inside && i >= 0 && i < static_cast<std::int64_t>(image_.size[axis]);
      voxel[axis] = static_cast<std::size_t>(std::max<std::int64_t>(i, 0));
    }
    const std::int32_t label = inside ? image_.at(voxel[0], voxel[1], voxel[2]) : 0;
    std::size_t entry = 0;
    while (entry < known && memberships[entry].first != label) ++entry;
    if (entry == known) memberships[known++] = {label, 0.0};
    memberships[entry].second += weight;
  }
  const auto less = [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second < b.second : a.first > b.first;
  };
  return std::max_element(memberships.begin(),
                          memberships.begin() + static_cast<std::ptrdiff_t>(known), less)
      ->first;
}

void scale_image(LabelImage& image, double unit, const std::string& where) {
  if (!(unit > 0)) {
    refuse(where, "the header does not state the unit of length", "give unit in [image]");
  }
  for (Vec3* vector : {&image.step[0], &image.step[1], &image.step[2], &image.origin}) {
    for (double& component : *vector) {
      component *= unit;
      if (!std::isfinite(component)) {
        refuse_geometry(where, "the orientation has a number that is not finite", kDamagedFile);
      }
    }
  }
}

LabelImage read_label_image(const std::filesystem::path& path, double unit) {
  const std::string kind = ending(path);
  check_readable(path);
  if (kind == ".nii" || kind == ".nii.gz")
    return read_nifti(nifti_bytes(path), unit, path.string());
  if (kind == ".nrrd" || kind == ".nhdr") return read_nrrd(read_bytes(path), unit, path);
  refuse_kind(path, "image", "NIfTI (.nii, .nii.gz) or NRRD (.nrrd, .nhdr)");
}

}  // namespace palpate::mesher
