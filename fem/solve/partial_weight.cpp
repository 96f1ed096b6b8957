// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/partial_weight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

constexpr double kResidualTolerance = 1e-9;  ///< residual over the weight
constexpr int kWeightNewtonSteps = 60;
constexpr int kFreeSteps = 4;
constexpr int kStepHalvings = 12;     ///< of a step
constexpr double kArmijo = 1e-4;      ///< decrease of the energy over that along the slope
constexpr double kContraction = 0.1;  ///< decrease of the residual that serves as well, relative
/// Residual of a refined step over its load, and how often it is refined at most.
constexpr double kRefined = 1e-6;
constexpr int kRefinements = 4;
constexpr int kPowerIterations = 30;  ///< for an eigenvalue: its order of magnitude suffices

double mean_edge(const QuadraticMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b] : mesh.edges) sum += (mesh.X.col(a) - mesh.X.col(b)).norm();
  return sum / static_cast<double>(mesh.edges.size());
}

/// The node with the largest norm of its three entries.
Eigen::Index largest_node(const Eigen::VectorXd& d) {
  Eigen::Index node = 0;
  Eigen::Map<const Eigen::Matrix3Xd>(d.data(), 3, d.size() / 3)
      .colwise()
      .squaredNorm()
      .maxCoeff(&node);
  return node;
}

}  // namespace

PartialWeight::PartialWeight(const SolidModel& model, const std::vector<int>& permutation,
                             const FactorResources& resources, PreloadCounter* counter)
    : model_(model),
      weight_(model.weight()),
      edge_(mean_edge(model.mesh())),
      resources_(resources),
      counter_(counter),
      factor_(model.pattern(), &permutation, {}) {
  use_one_thread_per_site();  // fronts are computed in parallel, their dense algebra is not
}

bool PartialWeight::factorize_in(Precision precision) {
  // Once: later the resident memory holds this factor and its fronts.
  int& threads = precision == Precision::Single ? threads_in_single_ : threads_in_double_;
  if (threads == 0)
    threads = threads_that_fit(resources_, [&](int t) { return factor_.bytes(precision, t); });
  return factor_.factorize(K_, precision, threads);
}

bool PartialWeight::factorize() {
  if (precision_ == Precision::Single && factorize_in(Precision::Single)) return true;
  if (!factorize_in(Precision::Double)) return false;
  precision_ = Precision::Double;
  return true;
}

void PartialWeight::solve_once(const Eigen::VectorXd& load, Eigen::VectorXd& d) {
  Eigen::VectorXd none;
  factor_.solve_forward(load, none);
  factor_.solve_backward(none, d);
}

bool PartialWeight::refine(const Eigen::VectorXd& load, Eigen::VectorXd& d) {
  solve_once(load, d);
  Eigen::VectorXd residual(load.size()), more;
  for (int i = 0; i < kRefinements; ++i) {
    symmetric_multiply(model_.pattern(), K_, d.data(), residual.data());
    residual = load - residual;
    if (residual.norm() <= kRefined * load.norm()) return true;
    solve_once(residual, more);
    d += more;
  }
  return false;
}

bool PartialWeight::solve(const Eigen::VectorXd& load, Eigen::VectorXd& d) {
  if (precision_ == Precision::Single) {
    if (refine(load, d)) return true;
    precision_ = Precision::Double;
    if (!factorize()) return false;
  }
  solve_once(load, d);
  return true;
}

/// The model has the whole weight; the excess is subtracted.
PartialWeight::State PartialWeight::evaluate(double part, const Displacement& u) const {
  State now;
  const SolidModel::State state = model_.forces(u, now.residual);
  now.residual += (1 - part) * weight_;
  now.energy = state.energy;
  for (int node = 0; node < model_.mesh().nodes(); ++node)
    if (const int first = model_.equation(node); first >= 0)
      now.energy += (1 - part) * weight_.segment<3>(first).dot(u.col(node));
  now.min_J = state.min_J;
  return now;
}

/// The norm of eps K_ii (|u| + h): the forces that a last digit of the displacements, and of F,
/// stands for.
double PartialWeight::rounding_error(const Displacement& u) const {
  double sum = 0;
  for (int i = 0; i < model_.pattern().n; ++i) {
    const double diagonal = K_[to_index(model_.pattern().start[to_index(i)])];
    sum += diagonal * diagonal;
  }
  const double size = u.colwise().norm().maxCoeff() + edge_;
  return std::numeric_limits<double>::epsilon() * size * std::sqrt(sum);
}

/// Leaves the stiffness at u for the next step where it is none.
bool PartialWeight::is_equilibrium(const State& now, const Displacement& u) {
  if (now.residual.norm() <= kResidualTolerance * weight_.norm()) return true;
  model_.stiffness(u, K_);
  return now.residual.norm() <= rounding_error(u);
}

bool PartialWeight::lowers(double length, const State& next) const {
  const State& from = checkpoint_.state;
  const double slope = from.residual.dot(checkpoint_.d);
  return next.energy <= from.energy + kArmijo * length * slope ||
         next.residual.norm() <= (1 - kContraction * length) * from.residual.norm();
}

bool PartialWeight::newton_step(const State& now, const Displacement& u, Eigen::VectorXd& d) {
  is_convex_ = factorize() && solve(-now.residual, d);
  if (is_convex_ || foretold_.empty()) return is_convex_;
  model_.stiffness(u, K_, nullptr, foretold_);
  return factorize() && solve(-now.residual, d);
}

/// Where the last step was with the stiffness of its state, the one here is positive definite, too.
bool PartialWeight::is_stable(const Displacement& u) {
  if (is_convex_) return true;
  model_.stiffness(u, K_);
  return factorize();
}

std::optional<PartialWeight::Outcome> PartialWeight::free_step(double part, State& now,
                                                               Displacement& u) {
  Eigen::VectorXd d;
  if (!newton_step(now, u, d)) return Outcome::Unstable;
  if (counter_ != nullptr) counter_->count_step();
  if (iterations_ == 0) first_step_ = d.segment<3>(3 * largest_node(d)).norm();
  if (free_steps_ == 0) checkpoint_ = {u, now, d};
  double length = 1;
  for (int halvings = 0; halvings < kStepHalvings; ++halvings, length *= 0.5) {
    Displacement trial = u;
    add_step(model_, length, d, trial);
    State next = evaluate(part, trial);
    if (!(next.min_J > 0)) continue;
    const bool lower = lowers(free_steps_ == 0 ? length : 1, next);
    if (!lower && free_steps_ == kFreeSteps) return Outcome::Unconverged;
    free_steps_ = lower ? 0 : free_steps_ + 1;
    foretold_ = model_.foretold_pressures(u, trial);
    u.swap(trial);
    now = std::move(next);
    return std::nullopt;
  }
  return Outcome::Inverted;
}

std::optional<PartialWeight::Outcome> PartialWeight::step_from_checkpoint(double part, State& now,
                                                                          Displacement& u) {
  free_steps_ = 0;
  double length = 0.5;
  for (int halvings = 1; halvings < kStepHalvings; ++halvings, length *= 0.5) {
    Displacement trial = checkpoint_.u;
    add_step(model_, length, checkpoint_.d, trial);
    State next = evaluate(part, trial);
    if (!(next.min_J > 0) || !lowers(length, next)) continue;
    foretold_ = model_.foretold_pressures(checkpoint_.u, trial);
    u.swap(trial);
    now = std::move(next);
    return std::nullopt;
  }
  return Outcome::Unconverged;
}

PartialWeight::Outcome PartialWeight::equilibrate(double part, Displacement& u) {
  foretold_.clear();
  is_convex_ = true;
  State now = evaluate(part, u);
  if (!(now.min_J > 0)) return Outcome::Inverted;
  free_steps_ = 0;
  for (iterations_ = 0; iterations_ < kWeightNewtonSteps; ++iterations_) {
    if (is_equilibrium(now, u)) return is_stable(u) ? Outcome::Found : Outcome::Unstable;
    std::optional<Outcome> failure = free_step(part, now, u);
    if (failure && free_steps_ > 0) failure = step_from_checkpoint(part, now, u);
    if (failure) return *failure;
  }
  return Outcome::Unconverged;
}

std::optional<PartialWeight::WeakestMode> PartialWeight::weakest_mode(const Displacement& u) {
  model_.stiffness(u, K_);
  if (!factorize()) return std::nullopt;
  // Inverse iteration from the weight and an uneven load: a mode of buckling may be normal to the
  // weight.
  Eigen::VectorXd mode = weight_ / weight_.norm();
  for (Eigen::Index i = 0; i < mode.size(); ++i)
    mode[i] += std::sin(static_cast<double>(i)) / std::sqrt(static_cast<double>(mode.size()));
  double stiffness = 0;
  for (int i = 0; i < kPowerIterations; ++i) {
    mode.normalize();
    const Eigen::VectorXd load = mode;
    if (i > 0)
      solve_once(load, mode);
    else if (!solve(load, mode))
      return std::nullopt;
    stiffness = 1 / mode.norm();
  }
  const auto largest = static_cast<int>(3 * largest_node(mode));
  for (int node = 0; node < model_.mesh().nodes(); ++node)
    if (model_.equation(node) == largest) return WeakestMode{stiffness, model_.mesh().X.col(node)};
  return std::nullopt;
}

}  // namespace palpate::fem
