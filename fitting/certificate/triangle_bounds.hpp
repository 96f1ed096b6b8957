// SPDX-License-Identifier: AGPL-3.0-or-later
// The bounds of every response triangle of a library.
#pragma once

#include <vector>

#include "fitting/certificate/slide_jacobian.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

/// Bounds of one triangle, and the causes of its slip bound.
struct TriangleBounds {
  TriangleCertificate certificate;
  double min_lipschitz_bound = 0;  ///< N/m, L_min: the smallest enforceable bound
  SlideCauses causes;
};

/// In the order of the triangles, while z + d0 <= depth (m). L_slip is (10) of
/// docs/theory-fitting.md, or the tighter bound of SlideSearch where (10) would determine the bound
/// of the library. A triangle with a hole is a border and has bounds of 0. Deterministic.
/// @throws Error(Geometry) where normals cannot be interpolated.
std::vector<TriangleBounds> triangle_bounds(const Library& library, double depth, double friction);

}  // namespace palpate::fitting
