// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/dilatation_multipliers.hpp"

#include <algorithm>

namespace palpate::fem {

namespace {

/// kappa/mu at rest of Poisson's ratio 0.49: softer penalties need more multiplier steps, stiffer
/// ones more steps of equilibrium (bench_precompute poisson).
constexpr double kPenalty = 2 * 1.49 / (3 * 0.02);
/// Smallest bulk modulus that pays for multipliers, over that of the penalty: Poisson's ratio
/// 0.495.
constexpr double kWorthwhile = 2;

/// dP_12/dF_12 at rest, Pa.
double shear_modulus_at_rest(const Law& law) {
  Tensor2<Lanes> F;
  for (std::size_t i = 0; i < F.size(); ++i) F[i] = Lanes::Constant(i % 4 == 0 ? 1 : 0);
  Fibres<Lanes> fibres;
  const std::array<Vec3, 2> directions = law.fibres_at({0, 0, 0});
  for (std::size_t family = 0; family < fibres.size(); ++family)
    for (std::size_t j = 0; j < 3; ++j) fibres[family][j] = Lanes::Constant(directions[family][j]);
  Tensor4<Lanes> A;
  for (auto& row : A) row.fill(Lanes::Zero());
  law.add_tangent(F, cofactor(F), Lanes::Constant(1), fibres, A);
  return A[1][1][0];
}

}  // namespace

DilatationMultipliers::DilatationMultipliers(const std::vector<Law>& laws, std::size_t pressures) {
  for (const Law& law : laws) {
    const double kappa = law.pressure_slope(Lanes::Constant(1))[0];
    const double penalty = kPenalty * shear_modulus_at_rest(law);
    kappa_.push_back(kappa);
    kappa_a_.push_back(kappa > kWorthwhile * penalty ? penalty : 0);
  }
  if (std::ranges::any_of(kappa_a_, [](double penalty) { return penalty > 0; }))
    values.assign(pressures, 0.0);
}

AugmentedVolume DilatationMultipliers::augmented(const Law& law, int region,
                                                 const std::array<int, kLanes>& pressure) const {
  AugmentedVolume augmented{law, kappa_[to_index(region)], kappa_a_[to_index(region)],
                            Lanes::Zero()};
  for (int lane = 0; lane < kLanes; ++lane)
    augmented.p[lane] = values[to_index(pressure[to_index(lane)])];
  return augmented;
}

}  // namespace palpate::fem
