// SPDX-License-Identifier: AGPL-3.0-or-later
// Vectors of the artifacts as vectors of Eigen, and back.
#pragma once

#include <Eigen/Core>

#include "format/vec3.hpp"

namespace palpate::fem {

inline Eigen::Vector3d to_eigen(const Vec3& v) {
  return Eigen::Vector3d(v.data());
}

inline Vec3 to_vec3(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace palpate::fem
