// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "format/to_index.hpp"
#include "format/vec3.hpp"

namespace palpate::fem {

/// What the surface of a case is.
enum class GivenShape {
  Unloaded,  ///< the shape without weight
  Loaded     ///< the shape as the body lies under its weight
};

/// Gravity on a body.
struct Gravity {
  Vec3 acceleration{};  ///< m/s^2
  double density = 0;   ///< kg/m^3, at rest
  GivenShape shape = GivenShape::Unloaded;
  std::vector<double> region_density{};  ///< of each region, kg/m^3; empty: `density` in all

  bool operator==(const Gravity&) const = default;

  bool acts() const { return norm(acceleration) > 0 && density > 0; }
  double density_of(int region) const {
    return region_density.empty() ? density : region_density[to_index(region)];
  }
};

}  // namespace palpate::fem
