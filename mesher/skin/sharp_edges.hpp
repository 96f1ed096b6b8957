// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "format/vec3.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// The edges whose dihedral deviation is over `angle` (rad), without connected fragments shorter
/// than kShortestFeature spacings, as `flag_sharp_edges`.
/// @param surface  closed and oriented
std::vector<Edge> sharp_edges(const Surface& surface, double angle, double spacing);

}  // namespace palpate::mesher
