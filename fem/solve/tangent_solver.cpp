// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/tangent_solver.hpp"

namespace palpate::fem {

namespace {

constexpr int kMaxIterations = 200;
constexpr double kRelativeResidual = 1e-6;

}  // namespace

TangentSolver::TangentSolver(const SolidModel& whole, const SolidModel& window,
                             RestSolve rest_solve)
    : whole_(whole),
      window_(window),
      rest_solve_(std::move(rest_solve)),
      factor_(window.pattern()),
      unknown_(to_index(window.pattern().n)) {
  for (int node = 0; node < window.mesh().nodes(); ++node)
    for (int i = 0; i < 3 && window.equation(node) >= 0; ++i)
      unknown_[to_index(window.equation(node) + i)] = whole.equation(node) + i;
  find_couplings();
}

void TangentSolver::find_couplings() {
  const SparsePattern& pattern = whole_.pattern();
  std::vector<int> inside(to_index(pattern.n), -1);
  for (std::size_t i = 0; i < unknown_.size(); ++i)
    inside[to_index(unknown_[i])] = static_cast<int>(i);
  for (int column = 0; column < pattern.n; ++column)
    for (int k = pattern.start[to_index(column)]; k < pattern.start[to_index(column) + 1]; ++k) {
      const int row = pattern.row[to_index(k)];
      if ((inside[to_index(row)] < 0) == (inside[to_index(column)] < 0)) continue;
      const auto [in, out] =
          inside[to_index(row)] < 0 ? std::pair(column, row) : std::pair(row, column);
      couplings_.push_back({inside[to_index(in)], out, k});
    }
}

bool TangentSolver::linearize(const ToolContact& contact, const Displacement& u) {
  whole_.stiffness(u, K_);
  contact.add_stiffness(whole_, u, true, K_);
  window_.stiffness(u, K_window_);
  contact.add_stiffness(window_, u, true, K_window_);
  return factor_.factorize(K_window_);
}

void TangentSolver::solve_window(Eigen::VectorXd& load, Eigen::VectorXd& x) {
  factor_.solve(load.data(), load.data(), workspace_);
  for (std::size_t i = 0; i < unknown_.size(); ++i)
    x[unknown_[i]] = load[static_cast<Eigen::Index>(i)];
}

Eigen::VectorXd TangentSolver::times(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y(x.size());
  symmetric_multiply(whole_.pattern(), K_, x.data(), y.data());
  for (const int i : unknown_) y[i] = 0;
  return y;
}

Eigen::VectorXd TangentSolver::preconditioned(const Eigen::VectorXd& r) {
  Eigen::VectorXd z;
  rest_solve_(r, z);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknown_.size()));
  for (const Coupling& c : couplings_) load[c.inside] -= K_[to_index(c.value)] * z[c.outside];
  solve_window(load, z);
  return z;
}

bool TangentSolver::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  x = Eigen::VectorXd::Zero(b.size());
  Eigen::VectorXd load(static_cast<Eigen::Index>(unknown_.size()));
  for (std::size_t i = 0; i < unknown_.size(); ++i)
    load[static_cast<Eigen::Index>(i)] = b[unknown_[i]];
  solve_window(load, x);
  Eigen::VectorXd r = b - times(x), p, q;
  for (const int i : unknown_) r[i] = 0;
  const double allowed = kRelativeResidual * r.norm();
  double last = 1;
  for (int i = 0; r.norm() > allowed; ++i, ++iterations_) {
    if (i == kMaxIterations) return false;
    const Eigen::VectorXd z = preconditioned(r), Kz = times(z);
    const double product = r.dot(z), beta = product / last;
    p = i == 0 ? z : z + beta * p;
    q = i == 0 ? Kz : Kz + beta * q;
    const double curvature = p.dot(q);
    if (!(curvature > 0) || !(product > 0)) return false;
    x += product / curvature * p;
    r -= product / curvature * q;
    last = product;
  }
  return true;
}

}  // namespace palpate::fem
