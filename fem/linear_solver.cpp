// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/linear_solver.hpp"

namespace palpate::fem {

bool DirectSolver::solve(const std::vector<double>& K, const Eigen::VectorXd& r, double,
                         Eigen::VectorXd& d) {
  if (!factor_.factorize(K)) return false;
  d.resize(r.size());
  factor_.solve(r.data(), d.data(), workspace_);
  return d.allFinite();
}

TwoLevelSolver::TwoLevelSolver(const SparsePattern& pattern, const Cholesky& rest_factor,
                               const std::vector<int>& window_unknowns)
    : pattern_(pattern),
      rest_factor_(rest_factor),
      window_(principal_submatrix(pattern, window_unknowns)),
      window_factor_(window_.pattern),
      window_values_(window_.source.size()),
      window_r_(window_.pattern.n),
      residual_(pattern.n),
      product_(pattern.n),
      correction_(pattern.n) {}

void TwoLevelSolver::add_window_correction(const Eigen::VectorXd& r, Eigen::VectorXd& z) {
  for (int i = 0; i < window_.pattern.n; ++i) window_r_[i] = r[window_.unknown[i]];
  window_factor_.solve(window_r_.data(), window_r_.data(), window_workspace_);
  for (int i = 0; i < window_.pattern.n; ++i) z[window_.unknown[i]] += window_r_[i];
}

void TwoLevelSolver::precondition(const std::vector<double>& K, const Eigen::VectorXd& r,
                                  Eigen::VectorXd& z) {
  ++applications_;
  z.setZero(r.size());
  add_window_correction(r, z);
  symmetric_multiply(pattern_, K, z.data(), product_.data());
  residual_ = r - product_;
  rest_factor_.solve(residual_.data(), correction_.data(), rest_workspace_);
  z += correction_;
  symmetric_multiply(pattern_, K, z.data(), product_.data());
  residual_ = r - product_;
  add_window_correction(residual_, z);
}

bool TwoLevelSolver::solve(const std::vector<double>& K, const Eigen::VectorXd& r,
                           double relative_tolerance, Eigen::VectorXd& d) {
  constexpr int kMaxIterations = 60;
  for (std::size_t i = 0; i < window_.source.size(); ++i) window_values_[i] = K[window_.source[i]];
  if (!window_factor_.factorize(window_values_)) return false;

  d.setZero(r.size());
  Eigen::VectorXd rest = r, z, p, Kp(r.size());
  const double target = relative_tolerance * r.norm();
  double rz = 0;
  for (int iteration = 0; iteration < kMaxIterations && rest.norm() > target; ++iteration) {
    precondition(K, rest, z);
    const double next = rest.dot(z);
    if (!(next > 0)) return false;
    p = iteration == 0 ? z : Eigen::VectorXd(z + (next / rz) * p);
    rz = next;
    symmetric_multiply(pattern_, K, p.data(), Kp.data());
    const double curvature = p.dot(Kp);
    if (!(curvature > 0)) return false;
    d += (rz / curvature) * p;
    rest -= (rz / curvature) * Kp;
  }
  return rest.norm() <= target && d.allFinite();
}

}  // namespace palpate::fem
