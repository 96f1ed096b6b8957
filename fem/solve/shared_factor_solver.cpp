// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/shared_factor_solver.hpp"

#include <algorithm>
#include <utility>

#include "fem/solid/rigid_motion.hpp"
#include "fem/solve/profile.hpp"

namespace palpate::fem {

namespace {

/// |R - 1| of the mean rotation from which the stiffness at rest is rotated with the body.
constexpr double kRotated = 5e-3;
/// Trials of a step, and the shortest to begin with.
constexpr int kMostTrials = 6;
constexpr double kShortestStep = 1e-4;
/// Length of a step without curvature pairs: K0^-1 does not know that the tool holds the surface,
/// and a whole step goes about twice as far as the minimum.
constexpr double kFirstStep = 0.5;
/// Factor on the sensitivity of the force from step to step.
constexpr double kDecay = 0.5;
/// The multipliers step where the error of the force has fallen below this part of that after their
/// last step.
constexpr double kNextMultipliers = 0.3;
/// Residual inside the window, over the tolerance and over the residual outside: far from
/// convergence it may be large. A larger one spoils the curvature pairs, and costs more steps
/// outside than it saves inside (bench_precompute profile).
constexpr double kInnerTolerance = 0.2, kInnerError = 0.007;
/// A surface that snaps moves through a long curved valley of its energy, in up to some 60 steps
/// inside the window. Half of an increment, tried where they do not suffice, costs more. A step
/// outside that asks for many is too long: half of it asks for few.
constexpr int kMostInnerSteps = 120, kInnerStepsOfTrial = 20;
/// Error of the force that the last step of the multipliers may leave, over the tolerance. What it
/// adds to the residual are pressures, and the force does not change by them in first order: along
/// a path the body moves with almost no change of volume (bench_precompute poisson).
constexpr double kMultiplierTolerance = 5;

/// The minimum of the parabola through the energy and its slope at 0 and the rise at a length, by a
/// factor of 0.5 to 0.01 of the length.
double shorter_step(double length, double slope, double rise) {
  const double minimum = -slope * length * length / (2 * (rise - slope * length));
  return std::clamp(minimum, 0.01 * length, 0.5 * length);
}

/// a - b on the first `count` unknowns.
Eigen::VectorXd difference(const SolidModel& model, Eigen::Index count, const Displacement& a,
                           const Displacement& b) {
  Eigen::VectorXd d(count);
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (const int first = model.equation(node); first >= 0 && first < count)
      d.segment<3>(first) = a.col(node) - b.col(node);
  return d;
}

}  // namespace

bool SharedFactorSolver::relax_window(const ToolContact& contact, const NewtonOptions& options,
                                      int most_steps, Displacement& u, NewtonResult& result) {
  NewtonOptions inner = options;
  inner.tolerance = std::max(kInnerTolerance * options.tolerance, kInnerError * error_);
  inner.reuse_factor = true;
  inner.max_iterations = most_steps;
  const NewtonResult relaxed = newton_.solve(contact, inner, u);
  if (!relaxed.converged) result.reason = relaxed.reason;
  return relaxed.converged;
}

Equilibrium SharedFactorSolver::evaluated(const ToolContact& contact, const Displacement& u) const {
  const PartTimer timer(Part::BodyPasses);
  Equilibrium now = evaluate(whole_, contact, u, &multipliers_);
  if (prolongation_ != nullptr) now.residual = prolongation_->reduced(now.residual);
  return now;
}

void SharedFactorSolver::add_step(double length, const Eigen::VectorXd& d, Displacement& u) const {
  add_rotating_step(whole_, length, prolongation_ != nullptr ? prolongation_->extended(d) : d, u);
}

Eigen::VectorXd SharedFactorSolver::direction(const Eigen::VectorXd& residual) {
  const double length = residual.norm();
  Eigen::VectorXf q = (residual / length).cast<float>();
  std::vector<float> alpha(pairs_.size());
  for (std::size_t i = pairs_.size(); i-- > 0;) {
    alpha[i] = pairs_[i].s.dot(q) / pairs_[i].sy;
    q -= alpha[i] * pairs_[i].y;
  }
  Eigen::VectorXd load = q.cast<double>(), solution;
  solve_rotated(load, solution);
  Eigen::VectorXf d = solution.cast<float>();
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    d += (alpha[i] - pairs_[i].y.dot(d) / pairs_[i].sy) * pairs_[i].s;
  return -length * d.cast<double>();
}

void SharedFactorSolver::solve_rotated(Eigen::VectorXd& q, Eigen::VectorXd& d) const {
  const PartTimer timer(Part::SharedSolves);
  if (turned_solve_) return turned_solve_(q, d);
  if (!rotated_) return rest_solve_(q, d);
  const auto rotate = [](const Eigen::Matrix3d& R, Eigen::VectorXd& v) {
    Eigen::Map<Eigen::Matrix3Xd> nodes(v.data(), 3, v.size() / 3);
    nodes = (R * nodes).eval();
  };
  rotate(rotation_.transpose(), q);
  rest_solve_(q, d);
  rotate(rotation_, d);
}

void SharedFactorSolver::remember(const Eigen::VectorXd& s, const Eigen::VectorXd& y) {
  Pair pair{s.cast<float>(), y.cast<float>(), 0};
  pair.sy = pair.s.dot(pair.y);
  if (!(pair.sy > 1e-10f * pair.s.norm() * pair.y.norm())) return;
  pairs_.push_back(std::move(pair));
  if (pairs_.size() > most_pairs_) pairs_.pop_front();
}

double SharedFactorSolver::longest_step(double energy, double slope) const {
  // To the minimum of a quadratic the energy falls by half the slope, and no further than to that
  // of the body at rest without the tool. Multipliers shift it a little.
  const double most = energy - bent_.least_energy;
  return most > 0 ? std::clamp(-2 * most / slope, kShortestStep, 1.0) : 1;
}

bool SharedFactorSolver::step(const ToolContact& contact, const NewtonOptions& options,
                              const Eigen::VectorXd& d, Equilibrium& now, Displacement& u,
                              NewtonResult& result) {
  const double slope = now.residual.dot(d);
  double length = (pairs_.empty() ? kFirstStep : 1) * longest_step(now.energy, slope);
  for (int trials = 0; trials < kMostTrials; ++trials) {
    const double tried = std::exchange(length, 0.5 * length);
    Displacement trial = u;
    add_step(tried, d, trial);
    if (!relax_window(contact, options, kInnerStepsOfTrial, trial, result)) continue;
    Equilibrium next = evaluated(contact, trial);
    result.reason = "steps invert an element";
    if (!(next.min_J > 0)) continue;
    result.reason = "neither the energy nor the residual falls along the step";
    const bool lower = next.energy <= now.energy + 1e-4 * tried * slope;
    if (!lower && next.residual.norm() > (1 - 0.1 * tried) * now.residual.norm()) {
      length = shorter_step(tried, slope, next.energy - now.energy);
      continue;
    }
    remember(difference(whole_, d.size(), trial, u), next.residual - now.residual);
    u.swap(trial);
    now = std::move(next);
    return true;
  }
  return false;
}

void SharedFactorSolver::start_path(const Eigen::Vector3d& tip, const Displacement& u) {
  restart();
  newton_.start_path();
  if (!multipliers_.any()) return;
  whole_.take_pressures(u, multipliers_);
  multiplier_path_.start(tip, multipliers_.values);
}

void SharedFactorSolver::accept(const Eigen::Vector3d& tip, const Displacement& u) {
  restart();
  if (!multipliers_.any()) return;
  whole_.take_pressures(u, multipliers_);
  if (multiplier_path_.empty()) return multiplier_path_.start(tip, multipliers_.values);
  multiplier_path_.add(tip, multipliers_.values);
}

SharedFactorSolver::Verdict SharedFactorSolver::judge(const ToolContact& contact,
                                                      const NewtonOptions& options, double force,
                                                      Equilibrium& now, Displacement& u,
                                                      NewtonResult& result) {
  const bool balanced = force_error() <= options.tolerance;
  if (!multipliers_.any()) return balanced ? Verdict::Converged : Verdict::GoOn;
  if (!balanced && force_error() > kNextMultipliers * error_after_multipliers_)
    return Verdict::GoOn;
  {
    const PartTimer timer(Part::BodyPasses);
    whole_.update(u, multipliers_);
  }
  if (!relax_window(contact, options, kMostInnerSteps, u, result)) return Verdict::Failed;
  now = evaluated(contact, u);
  error_ = imbalance(whole_, now.residual, options.round_off) / force;
  error_after_multipliers_ = force_error();
  const double allowed = (balanced ? kMultiplierTolerance : 1) * options.tolerance;
  return force_error() <= allowed ? Verdict::Converged : Verdict::GoOn;
}

NewtonResult SharedFactorSolver::solve(const ToolContact& contact, const NewtonOptions& options,
                                       Displacement& u) {
  if (!multipliers_.any()) return equilibrate(contact, options, u);
  const Eigen::Vector3d& tip = contact.tool().tip;
  if (multiplier_path_.empty()) start_path(tip, u);
  multipliers_.values = multiplier_path_.predict(tip);
  NewtonResult result = equilibrate(contact, options, u);
  if (result.converged) multiplier_path_.add(tip, multipliers_.values);
  return result;
}

void SharedFactorSolver::turn_factor(const Displacement& u) {
  const PartTimer timer(Part::SharedSolves);
  turned_solve_ = bent_.turned_solve(u);
  is_bent_ = true;
  most_pairs_ = kMostPairs;
  restart();
}

NewtonResult SharedFactorSolver::equilibrate(const ToolContact& contact,
                                             const NewtonOptions& options, Displacement& u) {
  NewtonResult result = descend(contact, options, u);
  turned_solve_ = nullptr;  // other sites wait for its place in memory
  return result;
}

NewtonResult SharedFactorSolver::descend(const ToolContact& contact, const NewtonOptions& options,
                                         Displacement& u) {
  const PartTimer timer(Part::Vectors);
  NewtonResult result;
  error_ = 0.1;
  error_after_multipliers_ = 1;
  rotation_ = mean_rotation(whole_.mesh(), u);
  rotated_ = (rotation_ - Eigen::Matrix3d::Identity()).norm() > kRotated;
  if (!relax_window(contact, options, kMostInnerSteps, u, result)) return result;
  Equilibrium now = evaluated(contact, u);
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const Eigen::Vector3d force = contact.tool_force(u);
    const double scale = std::max(force.norm(), options.least_force), last_error = error_;
    error_ = imbalance(whole_, now.residual, options.round_off) / scale;
    if (result.iterations > 0)
      sensitivity_ =
          std::max((force - before).norm() / (std::max(scale, before.norm()) * last_error),
                   kDecay * sensitivity_);
    before = force;
    const Verdict verdict = judge(contact, options, scale, now, u, result);
    if (verdict == Verdict::Failed) return result;
    if (verdict == Verdict::Converged) {
      result.converged = true;
      result.reason.clear();
      if (!multipliers_.any()) result.solid = now.solid;
      return result;
    }
    if (!turned_solve_ && result.iterations >= (is_bent_ ? bent_.then_after : bent_.after_steps))
      turn_factor(u);
    Eigen::VectorXd d = direction(now.residual);
    if (now.residual.dot(d) >= 0) {
      restart();
      d = direction(now.residual);
    }
    if (step(contact, options, d, now, u, result)) continue;
    if (!pairs_.empty()) {
      restart();
    } else if (!turned_solve_) {
      turn_factor(u);
    } else {
      result.reason = "no admissible step: " + result.reason;
      return result;
    }
  }
  result.reason = "no convergence in " + std::to_string(options.max_iterations) + " iterations";
  return result;
}

}  // namespace palpate::fem
