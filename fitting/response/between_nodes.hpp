// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "format/library.hpp"

namespace palpate::fitting {

/// Factors of the vertex responses that make the rendered force correct in the mean over the
/// triangles instead of at the vertices. Linear interpolation of a force f that is curved along the
/// surface is too large by
///   m = 1/24 sum over edges e of e . H e      (mean over a triangle, H the Hessian of f)
/// so vertex i gets the factor 1 - (area mean of m over its triangles) / f_i. On a uniform mesh
/// this is the least-squares projection (docs/theory-fitting.md, section 2). H is from the
/// quadratic that fits f at two rings of neighbours by least squares. The factor is 1 where there
/// are too few neighbours or a sharp edge, and where there is no response. It is limited to 1 +-
/// 0.2.
/// @param depth  depth at which forces are compared, m
std::vector<double> factors_between_nodes(const Library& library, double depth);

}  // namespace palpate::fitting
