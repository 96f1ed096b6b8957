// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace palpate::fem {

/// Two unit vectors t1, t2 that complete a unit normal n to a right-handed orthonormal frame
/// (t1, n x t1, n): t1 = n x e/|n x e|, e the coordinate axis along which |n| has its smallest
/// component. A function of the normal alone: azimuths are counted from t1.
inline std::array<Eigen::Vector3d, 2> tangent_frame(const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d first = normal.cross(Eigen::Vector3d::Unit(axis)).normalized();
  return {first, normal.cross(first)};
}

}  // namespace palpate::fem
