// SPDX-License-Identifier: AGPL-3.0-or-later
// Geometric bounds of one response triangle.
#pragma once

#include <array>
#include <cstddef>

#include "format/library.hpp"

namespace palpate::fitting {

/// All bounds are over the whole triangle. N is the inward facet normal, U(c) = sum n_l u_l,
/// n = U/|U|.
struct TriangleFrame {
  Vec3 normal{};                   ///< N
  std::array<Vec3, 3> inward{};    ///< u_l
  std::array<Vec3, 3> gradient{};  ///< grad n_l, 1/m; constant, in the plane, their sum is zero
  double least_length = 1;  ///< min |U(c)|, exact: distance of the origin from the triangle u_l
  double kappa = 0;         ///< 1/m, |dn/ds| <= kappa along any direction in the plane
  double twist = 0;         ///< 1/m, bound of the component of dn/ds normal to the slide, <= kappa
  double cos_theta = 1;     ///< min n . N, exact: the minimum is at a vertex
  double sin_theta = 0;
};

/// @throws Error(Geometry), naming triangle and position, where normals cannot be interpolated:
///   no area, u_l . N <= 0 at a vertex, or |U| < 0.5 somewhere.
TriangleFrame triangle_frame(const Library& library, std::size_t index);

/// |sum_l value_l grad n_l|: gradient of a quantity that is given at the vertices.
inline double gradient_norm(const std::array<Vec3, 3>& gradient, double v0, double v1, double v2) {
  // Differences: the gradients sum to zero, so equal values must give exactly zero.
  return norm((v1 - v0) * gradient[1] + (v2 - v0) * gradient[2]);
}

}  // namespace palpate::fitting
