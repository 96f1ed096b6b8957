// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "mesher/geometry/soup.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// Alpha over the offset of the wraps of a repair.
inline constexpr double kAlphaPerOffset = 30;

/// The alpha wrap [Portaneri et al. 2022] of the faces: closed and free of self-intersections
/// whatever the faces are. Details smaller than `alpha` (m) are bridged; the wrap lies `offset` (m)
/// outside.
Surface alpha_wrap(const Soup& soup, double alpha, double offset);

/// The same of triangles.
Surface alpha_wrap(const Surface& surface, double alpha, double offset);

/// 2 V / A: twice the distance that a closed sheet has between its sides. The wrap of an open
/// sheet is a skin around it, about two offsets thick.
double mean_thickness(const Surface& surface);

}  // namespace palpate::mesher
