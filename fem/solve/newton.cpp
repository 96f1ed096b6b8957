// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/newton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fem/solve/profile.hpp"

namespace palpate::fem {

namespace {

/// Tolerance of the solve on the patch, over that of the increment; and the least, over the
/// residual: a tool that has lost contact has no force to compare with.
constexpr double kPatchTolerance = 0.1, kLeastPatchTolerance = 1e-6;

/// What is added to the diagonal of S at most, over that of A. A pressed body is stable against the
/// tool, not without it: S is often indefinite.
constexpr double kMostStiffening = 30;

/// A factor in single precision whose solution of a test load is off by more, over the solution, is
/// computed in double precision: it would cost steps.
constexpr double kMostErrorOfSolution = 0.03;

constexpr const char* kNotDefinite =
    "the stiffness is not positive definite (loss of stability or ellipticity)";

/// A whole step to the minimum of a convex model lowers the energy by half its slope. One that
/// lowers it by more than this fraction is too short: the model has been stiffened.
constexpr double kStraight = 0.85;
constexpr double kLongestStep = 64;

/// Contraction of the residual in a step from which a factor is used again, and the largest
/// residual over the tool force. Where the elements under the tool are refined a factor takes as
/// long as three steps (bench_case_profile).
constexpr double kGoodContraction = 0.5, kSmallResidual = 0.01;
/// Residual over the tool force, where the tool has moved, above which the factor of before does
/// not serve a first step either (bench_case_profile).
constexpr double kLongIncrement = 0.3;
/// Part of the decrease of the energy that the model of a factor of another state foretells, which
/// a step with it must reach.
constexpr double kForetold = 0.5;

/// A patch that is needed is taken instead of a larger one where it has less than this part of its
/// unknowns: another analysis of the window takes as long as a factorization.
constexpr double kMuchSmaller = 0.5;

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
  now.solid = state;
  contact.add_forces(model, u, now.residual);
  return now;
}

void NewtonSolver::choose_patch(const ToolContact& contact, const Displacement& u,
                                bool factor_is_kept) {
  {
    const PartTimer timer(Part::Contact);
    const bool covered = patch_ && patch_->covers(contact, u);
    if (covered && factor_is_kept) return;
    ContactPatch needed(contact, model_, u);
    if (covered &&
        static_cast<double>(needed.size()) > kMuchSmaller * static_cast<double>(patch_->size()))
      return;
    patch_ = std::move(needed);
  }
  const PartTimer timer(Part::WindowAnalysis);
  factor_.emplace(model_.pattern(), permutation_, patch_->unknowns(), fronts_);
  precision_ = fastest_;
  precision_is_checked_ = precision_ == Precision::Double;
  const std::vector<int>& ours = patch_->unknowns();
  index_in_patch_.clear();
  for (const int unknown : factor_->kept())
    index_in_patch_.push_back(
        static_cast<int>(std::lower_bound(ours.begin(), ours.end(), unknown) - ours.begin()));
  factorized_ = false;
}

void NewtonSolver::raised_stiffness(const Displacement& u, double raised) {
  const PartTimer timer(Part::WindowPasses);
  std::vector<double> pressures;
  if (last_state_.cols() > 0) pressures = model_.foretold_pressures(last_state_, u, multipliers_);
  model_.stiffness(u, K_, multipliers_, pressures);
  const auto& start = model_.pattern().start;
  for (std::size_t i = 0; i + 1 < start.size(); ++i) K_[to_index(start[i])] *= 1 + raised;
}

double NewtonSolver::error_of_solution() {
  const Eigen::Index n{model_.pattern().n}, kept = patch_->size();
  Eigen::VectorXd load(n), x(n), product(n), on_kept(kept);
  for (Eigen::Index i = 0; i < n; ++i) load[i] = std::cos(static_cast<double>(i));
  const auto solve_beside_patch = [&](const Eigen::VectorXd& b, Eigen::VectorXd& solution) {
    factor_->solve_forward(b, on_kept);
    factor_->solve_backward(Eigen::VectorXd::Zero(kept), solution);
  };
  solve_beside_patch(load, x);
  symmetric_multiply(model_.pattern(), K_, x.data(), product.data());
  const double size = x.norm();
  solve_beside_patch(load - product, x);
  const double error = x.norm() / size;
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

bool NewtonSolver::factorize_as_precisely_as_needed() {
  if (precision_ == Precision::Single) {
    if (factor_->factorize(K_, Precision::Single)) {
      if (!precision_is_checked_ && error_of_solution() >= kMostErrorOfSolution)
        precision_ = Precision::Double;
      precision_is_checked_ = true;
      if (precision_ == Precision::Single) return true;
    } else if (precision_is_checked_) {
      return false;  // it is A that is not positive definite, not its rounding
    }
  }
  return factor_->factorize(K_, Precision::Double);
}

bool NewtonSolver::factorize(const ToolContact& contact, const Displacement& u) {
  const PartTimer timer(Part::WindowFactor);
  // Away from equilibrium a large pressure can make A indefinite beside the patch; raising its
  // diagonal still gives a direction of descent.
  constexpr std::array<double, 6> kRaised{0, 0.02, 0.1, 0.5, 2, 10};
  tip_of_factor_ = contact.tool().tip;
  factorized_ = std::any_of(kRaised.begin(), kRaised.end(), [&](double raised) {
    raised_stiffness(u, raised);
    return factorize_as_precisely_as_needed();
  });
  if (!factorized_) return false;
  const Eigen::MatrixXd& S = factor_->schur_complement();
  patch_stiffness_.S.resize(S.rows(), S.cols());
  for (Eigen::Index j = 0; j < S.cols(); ++j)
    for (Eigen::Index i = 0; i < S.rows(); ++i)
      patch_stiffness_.S(in_patch(i), in_patch(j)) = S(i, j);
  const std::vector<int>& ours = patch_->unknowns();
  patch_stiffness_.stiffening.resize(static_cast<Eigen::Index>(ours.size()));
  for (std::size_t i = 0; i < ours.size(); ++i)
    patch_stiffness_.stiffening[static_cast<Eigen::Index>(i)] =
        kMostStiffening * std::abs(K_[to_index(model_.pattern().start[to_index(ours[i])])]);
  patch_solver_.use(patch_stiffness_);
  return true;
}

std::optional<Eigen::VectorXd> NewtonSolver::direction(const ToolContact& contact,
                                                       const Displacement& u,
                                                       const Eigen::VectorXd& residual,
                                                       double tolerance) {
  const PartTimer timer(Part::WindowSolves);
  Eigen::VectorXd on_kept, d;
  factor_->solve_forward(-residual, on_kept);
  if (const Eigen::Index count = on_kept.size(); count > 0) {
    const PartTimer inner(Part::Contact);
    patch_->start_from(contact, u);
    Eigen::VectorXd on_patch(count);
    // The forces of the contact act on the patch alone: the solve need not carry them, and its
    // round-off is that of the residual.
    Eigen::VectorXd contact_forces = Eigen::VectorXd::Zero(residual.size());
    contact.add_forces(model_, u, contact_forces);
    for (Eigen::Index i = 0; i < count; ++i)
      on_patch[in_patch(i)] =
          on_kept[i] + contact_forces[factor_->kept()[static_cast<std::size_t>(i)]];
    const auto x =
        patch_solver_.minimum(*patch_, contact, on_patch, Eigen::VectorXd::Zero(count), tolerance);
    if (!x) return std::nullopt;
    for (Eigen::Index i = 0; i < count; ++i) on_kept[i] = (*x)[in_patch(i)];
  }
  factor_->solve_backward(on_kept, d);
  return d;
}

bool NewtonSolver::line_search(const ToolContact& contact, const Eigen::VectorXd& d, bool stale,
                               Equilibrium& now, Displacement& u) {
  const PartTimer timer(Part::WindowPasses);
  const double slope = now.residual.dot(d);
  const double norm = now.residual.norm();
  const double least = stale ? kForetold / 2 : 1e-4;  // a whole step falls by half of the slope
  double step = 1;
  for (int halvings = 0; halvings < (stale ? 1 : 12); ++halvings, step *= 0.5) {
    Displacement trial = u;
    add_step(model_, step, d, trial);
    Equilibrium next = evaluate(model_, contact, trial, multipliers_);
    if (!(next.min_J > 0)) continue;
    const bool lower =
        next.energy <= now.energy + least * step * slope + kEnergyNoise * std::abs(now.energy);
    // Close to the minimum the energy is at its round-off: judge by the gradient as well.
    if (!lower && next.residual.norm() > (1 - 0.1 * step) * norm) continue;
    if (step == 1 && next.energy < now.energy + kStraight * slope)
      lengthen(contact, d, u, now.energy, slope, next, trial);
    u.swap(trial);
    last_state_.swap(trial);
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
  NewtonResult result = descend(contact, options, u);
  if (result.converged)
    last_state_ = u;
  else
    start_path();
  return result;
}

NewtonResult NewtonSolver::descend(const ToolContact& contact, const NewtonOptions& options,
                                   Displacement& u) {
  const PartTimer timer(Part::WindowPasses);
  NewtonResult result;
  Equilibrium now = evaluate(model_, contact, u, multipliers_);
  if (!(now.min_J > 0)) {
    result.reason = "an element is inverted at the start of the increment";
    return result;
  }
  bool stale =
      options.reuse_factor && (contact.tool().tip == tip_of_factor_ ||
                               now.residual.norm() < kLongIncrement * contact.tool_force(u).norm());
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const double before = now.residual.norm();
    const double allowed =
        options.tolerance * std::max(contact.tool_force(u).norm(), options.least_force);
    if (imbalance(model_, now.residual, options.round_off) <= allowed) {
      result.converged = true;
      return result;
    }
    choose_patch(contact, u, stale && factorized_);
    stale = stale && factorized_;
    if (!stale && !factorize(contact, u)) {
      result.reason = kNotDefinite;
      return result;
    }
    const auto d = direction(contact, u, now.residual,
                             std::max(kPatchTolerance * allowed, kLeastPatchTolerance * before));
    const bool moved = d && line_search(contact, *d, stale, now, u);
    if (!moved && !stale) {
      result.reason =
          d ? "line search failed: no step keeps every element from inversion and lowers the energy"
            : kNotDefinite;
      return result;
    }
    const double after = now.residual.norm();
    stale = options.reuse_factor && moved && after < kGoodContraction * before &&
            after < kSmallResidual * allowed / options.tolerance;
  }
  result.reason = "no convergence in " + std::to_string(options.max_iterations) + " iterations";
  return result;
}

}  // namespace palpate::fem
