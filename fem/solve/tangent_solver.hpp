// SPDX-License-Identifier: AGPL-3.0-or-later
// Linear solves with the tangent of body and contact at an equilibrium, by the factor that all
// sites share.
#pragma once

#include <functional>
#include <vector>

#include "fem/contact/contact.hpp"
#include "fem/factor/cholesky.hpp"
#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// K x = b without factorizing K. As in SharedFactorSolver the window around the tool, with the
/// contact and the large strains, is eliminated by a factor of its own. The Schur complement of the
/// unknowns outside differs little from that at rest, whose inverse is the outer block of K0^-1.
/// Conjugate gradients, preconditioned by a solve with the factor of K0, therefore converge in few
/// iterations [Nocedal & Wright 2006, alg. 5.3].
/// One thread; the rest solve may be shared.
class TangentSolver {
 public:
  /// x = K0^-1 b on the unknowns of the whole body.
  using RestSolve = std::function<void(const Eigen::VectorXd& b, Eigen::VectorXd& x)>;

  TangentSolver(const SolidModel& whole, const SolidModel& window, RestSolve rest_solve);

  /// Computes the tangent at `u`. False when that of the window is not positive definite.
  bool linearize(const ToolContact& contact, const Displacement& u);

  /// x = K^-1 b, to 1e-6 of the initial residual outside the window. False when a direction of
  /// non-positive stiffness is found, or after 200 iterations.
  bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

  int iterations() const { return iterations_; }  ///< of all solves so far
  /// The tangent at the last linearize(), on the pattern of the whole body.
  const std::vector<double>& values() const { return K_; }

 private:
  /// An entry of K between an unknown of the window and one outside.
  struct Coupling {
    int inside;   ///< unknown of the window
    int outside;  ///< unknown of the whole body
    int value;    ///< index into the values
  };

  void find_couplings();
  /// K x outside the window, for an x that is in equilibrium there.
  Eigen::VectorXd times(const Eigen::VectorXd& x) const;
  /// Solves for the window part of x. The load is overwritten.
  void solve_window(Eigen::VectorXd& load, Eigen::VectorXd& x);
  /// Outside, the inverse of the Schur complement at rest times r; inside, in equilibrium with it.
  Eigen::VectorXd preconditioned(const Eigen::VectorXd& r);

  const SolidModel& whole_;
  const SolidModel& window_;
  RestSolve rest_solve_;
  Cholesky factor_;  ///< of the window
  SolveWorkspace workspace_;
  std::vector<int> unknown_;  ///< of the whole body, of each unknown of the window
  std::vector<Coupling> couplings_;
  std::vector<double> K_, K_window_;
  int iterations_ = 0;
};

}  // namespace palpate::fem
