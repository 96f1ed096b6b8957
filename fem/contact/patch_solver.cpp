// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/patch_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/factor/dense_cholesky.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// A facet that comes into contact or leaves it costs about one iteration.
constexpr int kPatchIterations = 50;
constexpr int kPatchHalvings = 10;
/// Contraction of the gradient in a step from which a factor is used again.
constexpr double kGoodContraction = 0.5;
/// Fractions of the stiffening to try where the model of the patch is not convex. The least that
/// makes it convex gives the longest step along the direction in which the surface snaps: with four
/// fractions, presses of an edge that snaps took three times as many steps or ended early.
constexpr std::array<double, 12> kStiffeningFractions{0,    1e-4,  3e-4, 1e-3, 2e-3, 4e-3,
                                                      8e-3, 0.015, 0.03, 0.06, 0.2,  1};

}  // namespace

void PatchSolver::use(const PatchStiffness& stiffness) {
  stiffness_ = &stiffness;
  in_core_.assign(static_cast<std::size_t>(stiffness.S.rows()), 0);
  condensed_.clear();
  next_fraction_ = 0;
}

std::size_t PatchSolver::stiffer_than(std::size_t fraction) const {
  // The stiffness changes little from one factorization to the next: start one below what the last
  // one needed.
  return std::max(fraction + 1, fraction == 0 && sufficient_fraction_ > 0 ? sufficient_fraction_ - 1
                                                                          : std::size_t{0});
}

bool PatchSolver::condense(std::size_t fraction) {
  if (condensed_ == in_core_ && fraction_ == fraction && !order_.empty()) return true;
  condensed_.clear();
  order_.resize(in_core_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<int>(i);
  const auto core = std::stable_partition(order_.begin(), order_.end(),
                                          [&](int i) { return in_core_[to_index(i)] == 0; });
  rest_ = core - order_.begin();
  core_index_.assign(order_.size(), -1);
  for (auto i = core; i != order_.end(); ++i)
    core_index_[to_index(*i)] = static_cast<int>(i - core);
  gather_in_order();
  eliminated_.diagonal() +=
      (kStiffeningFractions[fraction] * stiffness_->stiffening(order_)).cast<float>();
  if (!eliminate_first(rest_, eliminated_)) return false;
  single_S_ = eliminated_.bottomRightCorner(core_size(), core_size());
  S_ = single_S_.cast<double>();
  condensed_ = in_core_;
  factorized_ = false;
  fraction_ = fraction;
  return true;
}

void PatchSolver::gather_in_order() {
  const Eigen::MatrixXd& S = stiffness_->S;
  eliminated_.resize(size(), size());
  for (std::size_t j = 0; j < order_.size(); ++j) {
    const double* from = S.col(order_[j]).data();
    float* to = eliminated_.col(static_cast<Eigen::Index>(j)).data();
    for (std::size_t i = j; i < order_.size(); ++i) to[i] = static_cast<float>(from[order_[i]]);
  }
}

bool PatchSolver::factorize(const PatchContact& core, const ToolContact& contact,
                            const Eigen::VectorXd& d) {
  factorized_ = false;
  for (const bool geometric : {true, false}) {
    if (factorized_) break;
    factor_ = single_S_;
    core.add_hessian(contact, d, geometric, factor_);
    factorized_ = factorize_in_place(factor_);
  }
  return factorized_;
}

Eigen::VectorXd PatchSolver::newton_step(const Eigen::VectorXd& g) const {
  return -solve_factorized(factor_, g.cast<float>()).cast<double>();
}

bool PatchSolver::minimize(const PatchContact& core, const ToolContact& contact,
                           const Eigen::VectorXd& load, double tolerance, Eigen::VectorXd& d) {
  const auto S = S_.selfadjointView<Eigen::Lower>();
  Eigen::VectorXd contact_force, Sd = S * d;
  double contact_energy = core.gradient(contact, d, contact_force);
  Eigen::VectorXd g = Sd - load + contact_force;
  bool stale = factorized_;
  for (int iteration = 0; iteration < kPatchIterations && g.norm() > tolerance; ++iteration) {
    if (!stale && !factorize(core, contact, d)) return false;
    const double before = g.norm(), energy = 0.5 * d.dot(Sd) - load.dot(d) + contact_energy;
    const Eigen::VectorXd step = newton_step(g), S_step = S * step;
    const double slope = g.dot(step);
    Eigen::VectorXd trial, S_trial;
    const auto lowers = [&](double length) {
      trial = d + length * step;
      S_trial = Sd + length * S_step;
      const double next = 0.5 * trial.dot(S_trial) - load.dot(trial) + core.energy(contact, trial);
      return next <= energy + 1e-4 * length * slope + kEnergyNoise * std::abs(energy);
    };
    double length = 1;
    bool lower = lowers(length);
    if (stale && !lower) {
      stale = false;
      continue;
    }
    for (int halvings = 1; halvings < kPatchHalvings && !lower; ++halvings)
      lower = lowers(length *= 0.5);
    d.swap(trial);
    Sd.swap(S_trial);
    contact_energy = core.gradient(contact, d, contact_force);
    g = Sd - load + contact_force;
    stale = g.norm() < kGoodContraction * before;
  }
  return true;
}

bool PatchSolver::minimize_on_core(const ContactPatch& patch, const ToolContact& contact,
                                   const Eigen::VectorXd& load, double tolerance,
                                   Eigen::VectorXd& d) {
  Eigen::VectorXd ordered = load(order_), on_core = d(order_).tail(core_size());
  Eigen::VectorXf on_rest = ordered.head(rest_).cast<float>();
  const auto coupling = eliminated_.bottomLeftCorner(core_size(), rest_);
  solve_first_forward(eliminated_, rest_, on_rest);
  const Eigen::VectorXd condensed_load =
      ordered.tail(core_size()) - (coupling * on_rest).cast<double>();
  const bool convex =
      minimize(patch.restricted_to(core_index_), contact, condensed_load, tolerance, on_core);
  on_rest -= coupling.transpose() * on_core.cast<float>();
  solve_first_backward(eliminated_, rest_, on_rest);
  ordered << on_rest.cast<double>(), on_core;
  d(order_) = ordered;
  return convex;
}

std::optional<Eigen::VectorXd> PatchSolver::minimum(const ContactPatch& patch,
                                                    const ToolContact& contact,
                                                    const Eigen::VectorXd& load, Eigen::VectorXd d,
                                                    double tolerance) {
  expect(patch, contact, d);
  std::size_t fraction = next_fraction_;
  while (fraction < kStiffeningFractions.size()) {
    if (!condense(fraction) || !minimize_on_core(patch, contact, load, tolerance, d)) {
      fraction = stiffer_than(fraction);
      continue;
    }
    expect(patch, contact, d);
    if (in_core_ != condensed_) continue;
    next_fraction_ = fraction;
    if (fraction > 0) sufficient_fraction_ = fraction;
    return d;
  }
  return std::nullopt;
}

}  // namespace palpate::fem
