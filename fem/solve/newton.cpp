// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/newton.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/contact/increment_work.hpp"
#include "fem/factor/dense_cholesky.hpp"
#include "fem/solve/profile.hpp"

namespace palpate::fem {

namespace {

/// Tolerance of the solve on the patch, over that of the increment.
constexpr double kPatchTolerance = 0.1;

/// A whole step to the minimum of a convex model lowers the energy by half its slope. One that
/// lowers it by more than this fraction is too short: the model has been stiffened.
constexpr double kStraight = 0.85;
constexpr double kLongestStep = 64;

/// Contraction of the residual in a step from which a factor is used again. A factor takes as long
/// as some ten steps where the elements under the tool are refined (bench_precompute profile).
constexpr double kGoodContraction = 0.5;

}  // namespace

double imbalance(const SolidModel& model, const Eigen::VectorXd& residual, double round_off) {
  if (residual.norm() <= round_off) return 0;
  if (model.mesh().sprung.empty()) return residual.norm();
  const Eigen::Vector3d sum =
      Eigen::Map<const Eigen::Matrix3Xd>(residual.data(), 3, residual.size() / 3).rowwise().sum();
  return std::max(residual.norm(), sum.norm());
}

Equilibrium evaluate(const SolidModel& model, const ToolContact& contact, const Displacement& u,
                     const DilatationMultipliers* multipliers) {
  Equilibrium now;
  const SolidModel::State state = model.forces(u, now.residual, multipliers);
  const PartTimer timer(Part::Contact);
  now.energy = state.energy + contact.energy(u);
  now.min_J = state.min_J;
  contact.add_forces(model, u, now.residual);
  return now;
}

void NewtonSolver::choose_patch(const ToolContact& contact, const Displacement& u) {
  {
    const PartTimer timer(Part::Contact);
    if (patch_ && patch_->covers(contact, u)) return;
    patch_.emplace(contact, model_, u);
  }
  const PartTimer timer(Part::WindowAnalysis);
  factor_.emplace(model_.pattern(), permutation_, patch_->unknowns());
  const std::vector<int>& ours = patch_->unknowns();
  index_in_patch_.clear();
  for (const int unknown : factor_->last_unknowns())
    index_in_patch_.push_back(
        static_cast<int>(std::lower_bound(ours.begin(), ours.end(), unknown) - ours.begin()));
  factorized_ = false;
}

void NewtonSolver::shifted_stiffness(const Displacement& u, double patch, double all) {
  const PartTimer timer(Part::WindowPasses);
  model_.stiffness(u, K_, multipliers_);
  const auto& start = model_.pattern().start;
  for (std::size_t i = 0; i + 1 < start.size(); ++i) K_[to_index(start[i])] *= 1 + all;
  const std::vector<int>& ours = patch_->unknowns();
  patch_stiffness_.stiffening.resize(static_cast<Eigen::Index>(ours.size()));
  for (std::size_t i = 0; i < ours.size(); ++i) {
    double& diagonal = K_[to_index(start[to_index(ours[i])])];
    patch_stiffness_.stiffening[static_cast<Eigen::Index>(i)] = patch * std::abs(diagonal);
    diagonal += patch * std::abs(diagonal);
  }
}

bool NewtonSolver::factorize(const Displacement& u) {
  const PartTimer timer(Part::WindowFactor);
  // A pressed body is stable against the tool, not without it: A is often indefinite on the patch.
  // Away from equilibrium a large pressure can make the rest indefinite, too; raising the whole
  // diagonal still gives a direction of descent.
  struct Shift {
    double patch, all;
  };
  constexpr std::array<Shift, 6> kShifts{
      {{30, 0}, {30, 0.02}, {30, 0.1}, {30, 0.5}, {30, 2}, {30, 10}}};
  factorized_ = std::any_of(kShifts.begin(), kShifts.end(), [&](const Shift& shift) {
    shifted_stiffness(u, shift.patch, shift.all);
    return factor_->factorize(K_);
  });
  if (!factorized_) return false;
  root_ = factor_->last_block();
  const Eigen::MatrixXd ordered = product_with_transpose(root_);
  patch_stiffness_.S.resize(root_.rows(), root_.cols());
  for (Eigen::Index j = 0; j < root_.cols(); ++j)
    for (Eigen::Index i = j; i < root_.rows(); ++i)
      patch_stiffness_.S(in_patch(i), in_patch(j)) = patch_stiffness_.S(in_patch(j), in_patch(i)) =
          ordered(i, j);
  patch_stiffness_.S.diagonal() -= patch_stiffness_.stiffening;
  patch_solver_.use(patch_stiffness_);
  return true;
}

Eigen::VectorXd NewtonSolver::direction(const ToolContact& contact, const Displacement& u,
                                        const Eigen::VectorXd& residual, double tolerance) {
  const PartTimer timer(Part::WindowSolves);
  Eigen::VectorXd load = -residual, y(load.size()), d(load.size());
  contact.add_forces(model_, u, load);  // leaves the internal forces
  factor_->solve_forward(load.data(), y.data(), workspace_);
  if (const Eigen::Index count = root_.rows(); count > 0) {
    const PartTimer inner(Part::Contact);
    patch_->start_from(contact, u);
    Eigen::VectorXd x(count), ordered = root_.triangularView<Eigen::Lower>() * y.tail(count);
    for (Eigen::Index i = 0; i < count; ++i) x[in_patch(i)] = ordered[i];
    x = patch_solver_.minimum(*patch_, contact, x, Eigen::VectorXd::Zero(count), tolerance);
    for (Eigen::Index i = 0; i < count; ++i) ordered[i] = x[in_patch(i)];
    y.tail(count) = root_.transpose().triangularView<Eigen::Upper>() * ordered;
  }
  factor_->solve_backward(y.data(), d.data(), workspace_);
  return d;
}

bool NewtonSolver::line_search(const ToolContact& contact, const Eigen::VectorXd& d,
                               Equilibrium& now, Displacement& u) const {
  const PartTimer timer(Part::WindowPasses);
  const double slope = now.residual.dot(d);
  const double norm = now.residual.norm();
  double step = 1;
  for (int halvings = 0; halvings < 12; ++halvings, step *= 0.5) {
    Displacement trial = u;
    add_step(model_, step, d, trial);
    Equilibrium next = evaluate(model_, contact, trial, multipliers_);
    if (!(next.min_J > 0)) continue;
    const bool lower =
        next.energy <= now.energy + 1e-4 * step * slope + kEnergyNoise * std::abs(now.energy);
    // Close to the minimum the energy is at its round-off: judge by the gradient as well.
    if (!lower && next.residual.norm() > (1 - 0.1 * step) * norm) continue;
    if (step == 1 && next.energy < now.energy + kStraight * slope)
      lengthen(contact, d, u, now.energy, slope, next, trial);
    u.swap(trial);
    now = std::move(next);
    return true;
  }
  return false;
}

void NewtonSolver::lengthen(const ToolContact& contact, const Eigen::VectorXd& d,
                            const Displacement& from, double energy, double slope, Equilibrium& now,
                            Displacement& u) const {
  for (double step = 2; step <= kLongestStep; step *= 2) {
    Displacement trial = from;
    add_step(model_, step, d, trial);
    Equilibrium next = evaluate(model_, contact, trial, multipliers_);
    if (!(next.min_J > 0) || next.energy > now.energy) return;
    const bool straight = next.energy < energy + kStraight * step * slope;
    u.swap(trial);
    now = std::move(next);
    if (!straight) return;
  }
}

NewtonResult NewtonSolver::solve(const ToolContact& contact, const NewtonOptions& options,
                                 Displacement& u) {
  const PartTimer timer(Part::WindowPasses);
  NewtonResult result;
  Equilibrium now = evaluate(model_, contact, u, multipliers_);
  if (!(now.min_J > 0)) {
    result.reason = "an element is inverted at the start of the increment";
    return result;
  }
  bool stale = options.reuse_factor;
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const double before = now.residual.norm();
    const double allowed = options.tolerance * std::max(contact.tool_force(u).norm(), 1e-12);
    if (imbalance(model_, now.residual, options.round_off) <= allowed) {
      result.converged = true;
      return result;
    }
    choose_patch(contact, u);
    stale = stale && factorized_;
    if (!stale && !factorize(u)) {
      result.reason = "the stiffness is not positive definite (loss of stability or ellipticity)";
      return result;
    }
    const Eigen::VectorXd d = direction(contact, u, now.residual, kPatchTolerance * allowed);
    const bool moved = line_search(contact, d, now, u);
    if (!moved && !stale) {
      result.reason =
          "line search failed: no step keeps every element from inversion and lowers the energy";
      return result;
    }
    stale = options.reuse_factor && moved && now.residual.norm() < kGoodContraction * before;
  }
  result.reason = "no convergence in " + std::to_string(options.max_iterations) + " iterations";
  return result;
}

std::optional<double> NewtonSolver::work_between(const ToolContact& contact,
                                                 const Eigen::Vector3d& from,
                                                 const Displacement& before,
                                                 const Displacement& after) {
  if (!factorized_) return std::nullopt;
  const PartTimer timer(Part::Contact);
  return fem::work_between(*patch_, patch_stiffness_, contact, from, before, after);
}

}  // namespace palpate::fem
