// SPDX-License-Identifier: AGPL-3.0-or-later
// The direction into a body of voxels.
#pragma once

#include <array>

#include "format/vec3.hpp"
#include "mesher/read/image/label_image.hpp"

namespace palpate::app {

/// The faces of voxels lie across the axes of their grid, however the surface of the body runs. The
/// voxels around a point tell how it runs.
class VoxelNormals {
 public:
  explicit VoxelNormals(mesher::LabelImage image);

  /// Unit vector into the body at a point of its surface: the first moment about the point of the
  /// voxels with a label, less that of the others, over a ball some voxels wide. Zero where these
  /// are even.
  Vec3 inward(const Vec3& point) const;

 private:
  bool is_inside(const std::array<long, 3>& voxel) const;

  mesher::LabelImage image_;
  std::array<Vec3, 3> inverse_{};  ///< rows: index = inverse (point - origin)
  double radius_ = 0;              ///< m, of the ball
};

}  // namespace palpate::app
