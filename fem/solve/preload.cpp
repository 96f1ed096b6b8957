// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/preload.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "fem/factor/cholesky.hpp"
#include "fem/solve/newton.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

constexpr double kTolerance = 1e-9;  ///< residual over the weight
constexpr int kIterations = 30;
constexpr int kHalvings = 12;               ///< of a Newton step
constexpr double kSmallestPart = 1.0 / 64;  ///< of the weight, applied at once

/// Equilibrium under a part of the weight.
class PartialWeight {
 public:
  PartialWeight(const SolidModel& model, const std::vector<int>& permutation)
      : model_(model),
        weight_(model.weight()),
        factor_(model.pattern(), &permutation),
        x_(weight_.size()) {}

  double weight() const { return weight_.norm(); }

  /// False when it is not found; u is then no equilibrium.
  bool equilibrate(double part, Displacement& u) {
    State now = evaluate(part, u);
    for (int i = 0; i < kIterations && now.min_J > 0; ++i) {
      if (now.residual.norm() <= kTolerance * weight()) return true;
      model_.stiffness(u, K_);
      if (!factor_.factorize(K_)) return false;
      const Eigen::VectorXd load = -now.residual;
      factor_.solve(load.data(), x_.data(), workspace_);
      if (!step(part, now, u)) return false;
    }
    return false;
  }

 private:
  struct State {
    double energy, min_J;
    Eigen::VectorXd residual;
  };

  /// The model has the whole weight; the excess is subtracted.
  State evaluate(double part, const Displacement& u) const {
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

  bool step(double part, State& now, Displacement& u) const {
    const double slope = now.residual.dot(x_);
    double length = 1;
    for (int halvings = 0; halvings < kHalvings; ++halvings, length *= 0.5) {
      Displacement trial = u;
      add_step(model_, length, x_, trial);
      State next = evaluate(part, trial);
      if (!(next.min_J > 0)) continue;
      const bool lower = next.energy <= now.energy + 1e-4 * length * slope;
      if (!lower && next.residual.norm() > (1 - 0.1 * length) * now.residual.norm()) continue;
      u.swap(trial);
      now = std::move(next);
      return true;
    }
    return false;
  }

  const SolidModel& model_;
  Eigen::VectorXd weight_;
  Cholesky factor_;
  SolveWorkspace workspace_;
  std::vector<double> K_;
  Eigen::VectorXd x_;
};

/// Natural coordinates of the point of a flat triangle nearest to the origin [Ericson 2005,
/// sec. 5.1.5].
Eigen::Vector3d nearest_in_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a;
  const double d1 = -ab.dot(a), d2 = -ac.dot(a), d3 = -ab.dot(b), d4 = -ac.dot(b), d5 = -ab.dot(c),
               d6 = -ac.dot(c);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  return Eigen::Vector3d(va, vb, vc) / (va + vb + vc);
}

}  // namespace

Displacement equilibrium_under_weight(const SolidModel& model, const std::vector<int>& permutation,
                                      const std::string& owner) {
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  if (model.weight().isZero(0)) return u;
  PartialWeight body(model, permutation);
  double carried = 0, part = 1;
  while (carried < 1) {
    const double next = std::min(1.0, carried + part);
    Displacement trial = u;
    if (body.equilibrate(next, trial)) {
      u.swap(trial);
      carried = next;
      continue;
    }
    part *= 0.5;
    if (part >= kSmallestPart) continue;
    char problem[96];
    std::snprintf(problem, sizeof problem,
                  "there is no equilibrium beyond %.0f %% of the weight: the body buckles",
                  100 * carried);
    throw Error(ErrorKind::Geometry, "gravity on " + owner, problem,
                "check the direction and the units of gravity.acceleration, the density, the "
                "stiffness and the supports");
  }
  return u;
}

Eigen::Vector3d displacement_at(const QuadraticMesh& mesh, const Displacement& u,
                                const Eigen::Vector3d& X) {
  double nearest = std::numeric_limits<double>::infinity();
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
  for (const Facet& facet : mesh.facets) {
    const Eigen::Vector3d a = mesh.X.col(facet[0]) - X, b = mesh.X.col(facet[1]) - X,
                          c = mesh.X.col(facet[2]) - X;
    const Eigen::Vector3d L = nearest_in_triangle(a, b, c);
    const double distance = (L[0] * a + L[1] * b + L[2] * c).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    displacement.setZero();
    for (int i = 0; i < 3; ++i) {
      displacement += L[i] * (2 * L[i] - 1) * u.col(facet[to_index(i)]);
      displacement += 4 * L[i] * L[(i + 1) % 3] * u.col(facet[to_index(3 + i)]);
    }
  }
  return displacement;
}

}  // namespace palpate::fem
