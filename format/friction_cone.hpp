// SPDX-License-Identifier: Apache-2.0
// What friction holds.
#pragma once

#include "format/vec3.hpp"

namespace palpate {

/// Is a force of the tool on the body, N, in the cone of friction around the unit vector `inward`?
/// |f - (f . n) n| <= mu f . n
inline bool within_friction(const Vec3& force, const Vec3& inward, double friction) {
  const double push = dot(force, inward);
  return norm(force - push * inward) <= friction * push;
}

}  // namespace palpate
