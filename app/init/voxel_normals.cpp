// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/voxel_normals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::app {
namespace {

/// Radius of the ball, in the largest and in the smallest distance between neighbouring voxels.
constexpr double kOverLargest = 2.5, kOverSmallest = 4;

}  // namespace

VoxelNormals::VoxelNormals(mesher::LabelImage image) : image_(std::move(image)) {
  const std::array<Vec3, 3>& step = image_.step;
  const double volume = dot(step[0], cross(step[1], step[2]));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    inverse_[axis] = (1 / volume) * cross(step[(axis + 1) % 3], step[(axis + 2) % 3]);
  }
  const auto [smallest, largest] = std::minmax({norm(step[0]), norm(step[1]), norm(step[2])});
  radius_ = std::max(kOverLargest * largest, kOverSmallest * smallest);
}

bool VoxelNormals::is_inside(const std::array<long, 3>& voxel) const {
  std::array<std::size_t, 3> at{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    at[axis] = static_cast<std::size_t>(voxel[axis]);  // a negative one is huge
    if (at[axis] >= image_.size[axis]) return false;
  }
  return image_.at(at[0], at[1], at[2]) != 0;
}

Vec3 VoxelNormals::inward(const Vec3& point) const {
  std::array<long, 3> low{}, high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double middle = dot(inverse_[axis], point - image_.origin);
    const double reach = radius_ * norm(inverse_[axis]);
    low[axis] = std::lround(std::ceil(middle - reach));
    high[axis] = std::lround(std::floor(middle + reach));
  }
  Vec3 moment{};
  for (long k = low[2]; k <= high[2]; ++k)
    for (long j = low[1]; j <= high[1]; ++j)
      for (long i = low[0]; i <= high[0]; ++i) {
        const Vec3 index{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
        const Vec3 way = image_.point(index) - point;
        const double weight = 1 - dot(way, way) / (radius_ * radius_);
        if (weight > 0) moment = moment + (is_inside({i, j, k}) ? weight : -weight) * way;
      }
  const double length = norm(moment);
  return length > 0 ? (1 / length) * moment : Vec3{};
}

}  // namespace palpate::app
