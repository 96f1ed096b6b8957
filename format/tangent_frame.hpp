// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "format/vec3.hpp"

namespace palpate {

/// Two unit vectors t1, t2 = n x t1 that complete a unit normal n to a right-handed orthonormal
/// frame: t1 = n x e/|n x e|, e the x axis where |n_x| < 0.6, else the y axis. For computations
/// that do not depend on the choice of t1: azimuths of sites count from fem/mesh/tangent_frame.hpp.
inline std::array<Vec3, 2> tangent_frame(const Vec3& n) {
  const Vec3 axis = std::abs(n[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 across = cross(n, axis);
  const Vec3 first = (1 / norm(across)) * across;
  return {first, cross(n, first)};
}

}  // namespace palpate
