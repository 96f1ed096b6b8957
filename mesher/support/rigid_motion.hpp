// SPDX-License-Identifier: AGPL-3.0-or-later
// Whether supports prevent every rigid motion of a body.
#pragma once

#include <vector>

#include "format/vec3.hpp"

namespace palpate::mesher {

/// A fixed point, or one on springs along a direction and across it.
struct SupportedPoint {
  Vec3 x{};                      ///< m
  Vec3 normal{1, 0, 0};          ///< unit, direction of `along`
  double along = 1, across = 1;  ///< stiffnesses relative to the stiffest spring of the point
};

/// Whether the stiffness of the points against the six rigid motions is positive definite.
bool prevent_rigid_motion(const std::vector<SupportedPoint>& points);

}  // namespace palpate::mesher
