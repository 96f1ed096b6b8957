// SPDX-License-Identifier: AGPL-3.0-or-later
// The bounds of every response triangle of a library.
#pragma once

#include <vector>

#include "fitting/certificate/slide_jacobian.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

/// Bounds of one triangle, and what its slides are steep for.
struct TriangleBounds {
  TriangleCertificate certificate;
  double hold = 0;  ///< N/m, L_hold
  SlideCauses causes;
};

/// In the order of the triangles, while z + d0 <= depth (m). L_slip is (10) of
/// docs/theory-fitting.md, or the closer bound of a search where (10) would set that of the
/// library. A triangle with a hole has bounds of 0: it is a border. Deterministic.
/// @throws Error(Geometry) where normals cannot be interpolated.
std::vector<TriangleBounds> triangle_bounds(const Library& library, double depth, double friction);

}  // namespace palpate::fitting
