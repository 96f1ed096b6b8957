// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/factor/partial_factor.hpp"
#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// The factor of SolidModel::turned_stiffness(): of a body that has bent, for one site, in place of
/// the factor at rest that all sites share. One thread.
class TurnedFactor {
 public:
  /// `permutation`: elimination order of `body`. `precision`: in which to try first.
  /// @throws Error(Internal) where the stiffness is not positive definite, and when memory runs
  /// out.
  TurnedFactor(const SolidModel& body, const std::vector<int>& permutation, Precision precision,
               const Displacement& u);

  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

 private:
  PartialFactor factor_;
};

}  // namespace palpate::fem
