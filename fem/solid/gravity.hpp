// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "format/vec3.hpp"

namespace palpate::fem {

/// Gravity on a body of one density.
struct Gravity {
  Vec3 acceleration{};  ///< m/s^2
  double density = 0;   ///< kg/m^3, at rest
  bool acts() const { return norm(acceleration) > 0 && density > 0; }
};

}  // namespace palpate::fem
