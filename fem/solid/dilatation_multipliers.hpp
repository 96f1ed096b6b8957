// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "fem/laws/augmented_volume.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

/// The multipliers of nearly incompressible elements, see AugmentedVolume: a solver sees a solid of
/// moderate bulk modulus, and the multipliers restore the true one. Regions whose Poisson's ratio
/// is moderate have none and keep their law. Each pressure has one: that of an element, or that of
/// a place of NodalPressure.
class DilatationMultipliers {
 public:
  /// For a solid in which no region has any.
  DilatationMultipliers() = default;
  /// Multipliers of 0. `laws`: of the regions; `pressures`: their number.
  DilatationMultipliers(const std::vector<Law>& laws, std::size_t pressures);

  /// Whether any region has multipliers.
  bool any() const { return !values.empty(); }
  /// Whether the pressures of a region have multipliers.
  bool relax(int region) const { return any() && kappa_a_[to_index(region)] > 0; }
  /// The law of a region that has multipliers, with those of eight of its pressures.
  AugmentedVolume augmented(const Law& law, int region,
                            const std::array<int, kLanes>& pressure) const;

  std::vector<double> values;  ///< Pa; empty where no region has any

 private:
  std::vector<double> kappa_;    ///< by region, Pa
  std::vector<double> kappa_a_;  ///< by region, Pa; 0: no multipliers
};

}  // namespace palpate::fem
