// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "format/library.hpp"

namespace palpate::fitting {

/// By what the response of each vertex is multiplied so that what is rendered is right in the mean
/// over the triangles, and not at the vertices alone. Interpolated straight, a force f that is
/// curved along the surface is too large by
///   m = 1/24 sum over edges e of e . H e      (mean over a triangle, H the Hessian of f)
/// so that vertex i is scaled by 1 - (area mean of m over its triangles) / f_i: on an even mesh the
/// projection in the mean square, where the interpolant is 2.4 times as far
/// (docs/theory-fitting.md, section 2). H is that of the quadratic through f at the neighbours of
/// the neighbours, least squares; 1 where these are too few or lie around a sharp edge, and where
/// there is no response. A response is scaled by a fifth at most.
/// @param depth  at which forces are compared, m
std::vector<double> factors_between_nodes(const Library& library, double depth);

}  // namespace palpate::fitting
