// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/preload.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

#include "fem/mesh/point_text.hpp"
#include "fem/solve/partial_weight.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

constexpr double kSmallestPart = 1.0 / 1024;  ///< of the weight, applied at once
constexpr int kMostStepsInAll = 300;          ///< of all parts
constexpr int kEasy = 8;  ///< iterations up to which the next part is twice as large
/// Displacement over that of the linear body. Above it the body may have left, somewhere between
/// two equilibria, a state from which it buckles.
constexpr double kAmplified = 5;
/// Smallest eigenvalue of the stiffness over that without weight, below which the body buckles.
constexpr double kVanished = 0.05;
/// The same, above which a stiffness that is not positive definite is no buckling of the body.
constexpr double kUnchanged = 0.5;

using Outcome = PartialWeight::Outcome;

std::string percent(double part) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * part);
  return text;
}

/// Equilibria from no weight to all of it, in parts.
class WeightPath {
 public:
  WeightPath(const SolidModel& model, PartialWeight& body, PreloadCounter& counter,
             std::string owner)
      : model_(model),
        body_(body),
        counter_(counter),
        owner_(std::move(owner)),
        u_(Displacement::Zero(3, model.mesh().nodes())),
        weakest_(body.weakest_mode(u_)),
        stiffness_at_rest_(weakest_ ? weakest_->stiffness : 0) {}

  /// @throws Error(Geometry)
  Displacement follow() {
    double part = 0.5;
    int iterations = 0;
    while (carried_ < 1) {
      const double next = std::min(1.0, carried_ + part);
      Displacement u = u_;
      if (iterations > kMostStepsInAll) refuse_outcome(Outcome::Unconverged, u);
      const Outcome outcome = body_.equilibrate(next, u);
      iterations += body_.iterations();
      if (outcome == Outcome::Found && follows(u)) {
        if (body_.iterations() <= kEasy) part *= 2;
        accept(next, std::move(u));
        continue;
      }
      part *= 0.5;
      if (part < kSmallestPart) refuse_outcome(outcome, u);
    }
    return u_;
  }

 private:
  bool follows(const Displacement& u) const {
    return (u - u_).colwise().norm().maxCoeff() <= kAmplified * body_.first_step();
  }

  void accept(double part, Displacement u) {
    carried_ = part;
    counter_.carry(part);
    u_ = std::move(u);
    if (carried_ == 1) return;
    weakest_ = body_.weakest_mode(u_);
    if (remaining_stiffness() < kVanished) refuse_unstable();
  }

  double remaining_stiffness() const {
    return weakest_ ? weakest_->stiffness / stiffness_at_rest_ : 0;
  }

  /// The weight at which the stiffness vanishes, by a straight line from that without weight.
  double critical_part() const { return carried_ / (1 - remaining_stiffness()); }

  [[noreturn]] void refuse_unstable() const {
    std::string problem = "the body buckles or collapses: its stiffness vanishes near " +
                          percent(critical_part()) + " of its weight";
    if (weakest_) problem += ", and it moves most at " + point_text(weakest_->X);
    refuse_geometry("gravity on " + owner_, problem,
                    "support it there, or check the direction and the unit of "
                    "gravity.acceleration, the density and the stiffness");
  }

  [[noreturn]] void refuse_outcome(Outcome outcome, const Displacement& u) const {
    const bool unstable = outcome == Outcome::Unstable || outcome == Outcome::Found;
    if (unstable && carried_ > 0 && remaining_stiffness() < kUnchanged) refuse_unstable();
    const std::string beyond = " beyond " + percent(carried_) + " of the weight";
    if (outcome == Outcome::Unconverged)
      refuse_geometry("gravity on " + owner_, "Newton's method does not converge" + beyond,
                      "check the units of gravity.acceleration, the density and the stiffness; "
                      "smaller elements may help");
    const SolidModel::Compressed worst = model_.most_compressed(u);
    refuse_geometry("gravity on " + owner_,
                    "there is no stable equilibrium" + beyond + "; the element at " +
                        point_text(worst.X) + " is compressed most",
                    "check the units of gravity.acceleration, the density and the stiffness, and "
                    "the supports");
  }

  const SolidModel& model_;
  PartialWeight& body_;
  PreloadCounter& counter_;
  std::string owner_;
  double carried_ = 0;
  Displacement u_;
  std::optional<PartialWeight::WeakestMode> weakest_;
  double stiffness_at_rest_;
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
                                      const std::string& owner, const PreloadOptions& options) {
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  if (model.weight().isZero(0)) return u;
  PreloadCounter counter(options.progress);
  PartialWeight body(model, permutation, options.resources, &counter);
  if (body.equilibrate(1, u) == Outcome::Found) {
    const double largest = u.colwise().norm().maxCoeff();
    if (largest <= kAmplified * body.first_step()) return u;
  }
  return WeightPath(model, body, counter, owner).follow();
}

BoundaryPoint nearest_boundary_point(const QuadraticMesh& mesh, const Eigen::Matrix3Xd& positions,
                                     const Eigen::Vector3d& x) {
  double nearest = std::numeric_limits<double>::infinity();
  BoundaryPoint point{};
  for (const Facet& facet : mesh.facets) {
    const Eigen::Vector3d a = positions.col(facet[0]) - x, b = positions.col(facet[1]) - x,
                          c = positions.col(facet[2]) - x;
    const Eigen::Vector3d L = nearest_in_triangle(a, b, c);
    const double distance = (L[0] * a + L[1] * b + L[2] * c).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    point.facet = facet;
    for (int i = 0; i < 3; ++i) {
      point.N[to_index(i)] = L[i] * (2 * L[i] - 1);
      point.N[to_index(3 + i)] = 4 * L[i] * L[(i + 1) % 3];
    }
  }
  return point;
}

Eigen::Vector3d BoundaryPoint::value(const Eigen::Matrix3Xd& field) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    sum += N[i] * field.col(facet[i]);
    sum += N[3 + i] * field.col(facet[3 + i]);
  }
  return sum;
}

Eigen::Vector3d displacement_at(const QuadraticMesh& mesh, const Displacement& u,
                                const Eigen::Vector3d& X) {
  return nearest_boundary_point(mesh, mesh.X, X).value(u);
}

}  // namespace palpate::fem
