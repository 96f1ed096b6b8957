// SPDX-License-Identifier: Apache-2.0
// Pose of the body in the world of the tool.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "format/vec3.hpp"

namespace palpate::runtime {

/// x_world = rotation x_body + position. Rotation by rows. noexcept, allocation-free.
struct Pose {
  std::array<Vec3, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 position{};  ///< m

  Vec3 turn(const Vec3& v) const noexcept {
    return {dot(rotation[0], v), dot(rotation[1], v), dot(rotation[2], v)};
  }
  Vec3 to_world(const Vec3& x) const noexcept { return turn(x) + position; }
  Vec3 to_body(const Vec3& x) const noexcept {
    const Vec3 r = x - position;
    return r[0] * rotation[0] + r[1] * rotation[1] + r[2] * rotation[2];
  }
  /// Orthonormal to `tolerance`, right-handed, all finite.
  bool is_rigid(double tolerance) const noexcept {
    bool good = std::isfinite(norm(position));
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const double wanted = i == j ? 1 : 0;
        good = good && std::abs(dot(rotation[i], rotation[j]) - wanted) <= tolerance;
      }
    }
    return good && dot(cross(rotation[0], rotation[1]), rotation[2]) > 0;
  }
};

}  // namespace palpate::runtime
