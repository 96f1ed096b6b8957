// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/stability.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

/// Logarithmic strains on a ray of states from uniaxial extension (`fraction` 0) over pure shear to
/// uniaxial compression (1): by isotropy the other directions of strain repeat these.
std::array<double, 3> strains_on_ray(double fraction, double largest) {
  const double angle = fraction * std::numbers::pi / 3;
  std::array<double, 3> e{};
  for (std::size_t i = 0; i < 3; ++i) {
    e[i] = std::cos(angle - 2 * std::numbers::pi / 3 * static_cast<double>(i));
  }
  const double scale = largest / std::max(std::abs(e[0]), std::abs(e[2]));
  for (double& value : e) value *= scale;
  return e;
}

}  // namespace

StabilityLimit stability_in(const IncompressibleLaw& law, const std::vector<double>& constants,
                            StabilityLimit range) {
  constexpr int steps = 200;
  range.unstable_at = kUnknown;
  const double rest = rest_of(range.mode);
  for (const double end : {range.high, range.low}) {
    for (int i = 0; i <= steps; ++i) {
      const double s = rest + (end - rest) * i / steps;
      if (law.least_tangent(constants.data(), logarithmic_strains(range.mode, s)) > 0) continue;
      range.unstable_at = s;
      return range;
    }
  }
  return range;
}

StabilityOfStates stability_of_states(const IncompressibleLaw& law,
                                      const std::vector<double>& constants, double largest_strain) {
  constexpr int steps = 100, rays = 30;
  StabilityOfStates result{largest_strain, {kUnknown, kUnknown, kUnknown}};
  for (int i = 1; i <= steps; ++i) {
    for (int ray = 0; ray <= rays; ++ray) {
      const auto e = strains_on_ray(static_cast<double>(ray) / rays, largest_strain * i / steps);
      if (law.least_tangent(constants.data(), e) > 0) continue;
      for (std::size_t k = 0; k < 3; ++k) result.unstable_at[k] = std::exp(e[k]);
      return result;
    }
  }
  return result;
}

}  // namespace palpate::calibrate
