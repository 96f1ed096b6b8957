// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// Alpha over the offset of the wraps of a repair.
inline constexpr double kAlphaPerOffset = 30;

/// The alpha wrap [Portaneri et al. 2022] of triangles: closed and free of self-intersections
/// whatever the triangles are. Details smaller than `alpha` (m) are bridged; the wrap lies `offset`
/// (m) outside.
Surface alpha_wrap(const Surface& surface, double alpha, double offset);

}  // namespace palpate::mesher
