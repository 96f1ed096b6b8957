// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/newton.hpp"

#include <algorithm>
#include <array>

namespace palpate::fem {

namespace {

/// Round-off of an energy summed over the elements, relative.
constexpr double kEnergyNoise = 1e-14;

}  // namespace

void move(const SolidModel& model, double s, const Eigen::VectorXd& d, Displacement& u) {
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (model.equation(node) >= 0) u.col(node) += s * d.segment<3>(model.equation(node));
}

Equilibrium evaluate(const SolidModel& model, const SphereContact& contact, const Displacement& u) {
  Equilibrium now;
  const SolidModel::State state = model.forces(u, now.residual);
  now.energy = state.energy + contact.energy(u);
  now.min_J = state.min_J;
  contact.add_forces(model, u, now.residual);
  return now;
}

bool NewtonSolver::factorize(const SphereContact& contact, const Displacement& u) {
  // Away from equilibrium a large pressure can make the stiffness indefinite. Leaving out the
  // negative term of the contact, then raising the diagonal, still gives a direction of descent.
  constexpr std::array<double, 7> kShifts{0, 0, 0.02, 0.1, 0.5, 2, 10};
  for (std::size_t attempt = 0; attempt < kShifts.size(); ++attempt) {
    model_.stiffness(u, K_);
    contact.add_stiffness(model_, u, attempt == 0, K_);
    const auto& start = model_.pattern().start;
    for (std::size_t i = 0; i + 1 < start.size(); ++i) K_[at(start[i])] *= 1 + kShifts[attempt];
    factorized_ = factor_.factorize(K_);
    if (factorized_) return true;
  }
  return false;
}

bool NewtonSolver::line_search(const SphereContact& contact, const Eigen::VectorXd& d,
                               Equilibrium& now, Displacement& u) const {
  const double slope = now.residual.dot(d);
  const double norm = now.residual.norm();
  double step = 1;
  for (int halvings = 0; halvings < 12; ++halvings, step *= 0.5) {
    Displacement trial = u;
    move(model_, step, d, trial);
    Equilibrium next = evaluate(model_, contact, trial);
    if (!(next.min_J > 0)) continue;
    const bool lower = next.energy <= now.energy + 1e-4 * step * slope + kEnergyNoise * now.energy;
    // Close to the minimum the energy is at its round-off: judge by the gradient as well.
    if (!lower && next.residual.norm() > (1 - 0.1 * step) * norm) continue;
    u.swap(trial);
    now = std::move(next);
    return true;
  }
  return false;
}

NewtonResult NewtonSolver::solve(const SphereContact& contact, const NewtonOptions& options,
                                 Displacement& u) {
  constexpr double kGoodContraction = 0.3;
  NewtonResult result;
  Equilibrium now = evaluate(model_, contact, u);
  if (!(now.min_J > 0)) {
    result.reason = "an element is inverted at the start of the increment";
    return result;
  }
  bool stale = options.reuse_factor && factorized_;
  Eigen::VectorXd d(model_.pattern().n);
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const double before = now.residual.norm();
    if (before <= options.tolerance * std::max(contact.tool_force(u).norm(), 1e-12)) {
      result.converged = true;
      return result;
    }
    if (!stale && !factorize(contact, u)) {
      result.reason = "the stiffness is not positive definite (loss of stability or ellipticity)";
      return result;
    }
    const Eigen::VectorXd load = -now.residual;
    factor_.solve(load.data(), d.data(), workspace_);
    const bool moved = line_search(contact, d, now, u);
    if (!moved && !stale) {
      result.reason = "no step along the Newton direction keeps det F > 0 and lowers the energy";
      return result;
    }
    stale = options.reuse_factor && moved && now.residual.norm() < kGoodContraction * before;
  }
  result.reason = "no convergence in " + std::to_string(options.max_iterations) + " iterations";
  return result;
}

}  // namespace palpate::fem
