// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/newton.hpp"

#include <algorithm>

namespace palpate::fem {

Displacement moved(const QuadraticMesh& mesh, const Displacement& u, double s,
                   const Eigen::VectorXd& d) {
  Displacement result = u;
  for (int node = 0; node < mesh.nodes(); ++node)
    if (mesh.equation[node] >= 0) result.col(node) += s * d.segment<3>(mesh.equation[node]);
  return result;
}

NewtonSolver::Evaluation NewtonSolver::evaluate(const Displacement& u) const {
  Evaluation now;
  const SolidModel::State state = model_.forces(u, now.residual);
  now.energy = state.energy + contact_.energy(u);
  now.min_J = state.min_J;
  contact_.add_forces(u, now.residual);
  return now;
}

bool NewtonSolver::direction(const Displacement& u, const Eigen::VectorXd& residual,
                             double tolerance, Eigen::VectorXd& d) {
  // Without the geometric term of the contact the stiffness is only closer to positive definite.
  for (const bool geometric : {true, false}) {
    model_.stiffness(u, K_);
    contact_.add_stiffness(u, geometric, K_);
    if (solver_.solve(K_, -residual, tolerance, d)) return true;
    if (fallback_ && fallback_->solve(K_, -residual, tolerance, d)) return true;
  }
  return false;
}

bool NewtonSolver::line_search(const Eigen::VectorXd& d, Evaluation& now, Displacement& u) const {
  const double slope = now.residual.dot(d);
  const double norm = now.residual.norm();
  double step = 1;
  for (int halvings = 0; halvings < 12; ++halvings, step *= 0.5) {
    const Displacement trial = moved(model_.mesh(), u, step, d);
    Evaluation next = evaluate(trial);
    if (!(next.min_J > 0)) continue;
    const bool lower = next.energy <= now.energy + 1e-4 * step * slope;
    // Close to the minimum the energy is at its round-off: judge by the gradient.
    if (!lower && next.residual.norm() > (1 - 0.1 * step) * norm) continue;
    u = trial;
    now = std::move(next);
    return true;
  }
  return false;
}

NewtonResult NewtonSolver::solve(const NewtonOptions& options, Displacement& u) {
  NewtonResult result;
  Evaluation now = evaluate(u);
  if (!(now.min_J > 0)) {
    result.reason = "an element is inverted at the start of the increment";
    return result;
  }
  Eigen::VectorXd d;
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const double scale = std::max(contact_.tool_force(u).norm(), 1e-12);
    const double error = now.residual.norm() / scale;
    if (error <= options.tolerance) {
      result.converged = true;
      return result;
    }
    const double forcing = std::clamp(0.3 * options.tolerance / error, 1e-4, 1e-2);
    if (!direction(u, now.residual, forcing, d)) {
      result.reason = "the stiffness is not positive definite (loss of stability or ellipticity)";
      return result;
    }
    if (!line_search(d, now, u)) {
      result.reason = "no step along the Newton direction keeps det F > 0 and lowers the energy";
      return result;
    }
  }
  result.reason = "no convergence in " + std::to_string(options.max_iterations) + " iterations";
  return result;
}

}  // namespace palpate::fem
