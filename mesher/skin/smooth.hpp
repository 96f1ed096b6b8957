// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

struct SmoothSettings {
  double feature_angle = 0;  ///< rad; sharper edges stay, but curve along themselves
  double spacing = 0;        ///< m, patch spacing: shorter fragments of sharp edges are smooth
  double longest = 0;        ///< m; longer edges are halved where the surface is curved along them
};

/// A smooth surface through the points of a faceted one. The normal of a point is the mean of its
/// facets, weighted by their angles [Thuermer & Wuethrich 1998], and an edge is the cubic that is
/// normal to those of its ends, A and B [Vlachos, Peters, Boyd & Mitchell 2001]: with d = B - A its
/// middle is
///   (A + B)/2 - ((d . n_A) n_A - (d . n_B) n_B)/8.
/// Sharp edges have tangents instead, those of the circle through three points of a sharp line;
/// where such lines end, fork or turn sharply, their edges stay straight. Edges are halved until
/// they are short; names of faces are handed on to their parts.
/// @param surface  closed and oriented
/// @throws Error(Geometry) where the smooth surface self-intersects
Surface smooth(const Surface& surface, const SmoothSettings& settings, const std::string& where);

}  // namespace palpate::mesher
