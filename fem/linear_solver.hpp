// SPDX-License-Identifier: AGPL-3.0-or-later
// Two ways to solve K d = r for the consistent stiffness of one Newton iteration.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/cholesky.hpp"
#include "fem/sparse_pattern.hpp"

namespace palpate::fem {

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// Solve to |K d - r| <= relative_tolerance |r|. False when K is not positive definite as far as
  /// the solver can tell, or the iteration stalls.
  virtual bool solve(const std::vector<double>& K, const Eigen::VectorXd& r,
                     double relative_tolerance, Eigen::VectorXd& d) = 0;
};

/// Factorizes K every time: the reference, and the last resort.
class DirectSolver : public LinearSolver {
 public:
  explicit DirectSolver(const SparsePattern& pattern) : factor_(pattern) {}
  bool solve(const std::vector<double>& K, const Eigen::VectorXd& r, double relative_tolerance,
             Eigen::VectorXd& d) override;

 private:
  Cholesky factor_;
  SolveWorkspace workspace_;
};

/// Conjugate gradients with a symmetric multiplicative two-level preconditioner: an exact solve in
/// the window around the tool, the factor K0 of the rest stiffness everywhere, the window again.
/// The window holds all that changes fast (contact, large strain); K0 is shared by all sites.
class TwoLevelSolver : public LinearSolver {
 public:
  TwoLevelSolver(const SparsePattern& pattern, const Cholesky& rest_factor,
                 const std::vector<int>& window_unknowns);
  bool solve(const std::vector<double>& K, const Eigen::VectorXd& r, double relative_tolerance,
             Eigen::VectorXd& d) override;

  long applications() const { return applications_; }  ///< of the preconditioner, so far

 private:
  void add_window_correction(const Eigen::VectorXd& r, Eigen::VectorXd& z);
  void precondition(const std::vector<double>& K, const Eigen::VectorXd& r, Eigen::VectorXd& z);

  const SparsePattern& pattern_;
  const Cholesky& rest_factor_;
  Submatrix window_;
  Cholesky window_factor_;
  SolveWorkspace rest_workspace_, window_workspace_;
  std::vector<double> window_values_;
  Eigen::VectorXd window_r_, residual_, product_, correction_;
  long applications_ = 0;
};

}  // namespace palpate::fem
