// SPDX-License-Identifier: Apache-2.0
// The response between the nodes: response functions are interpolated, not forces.
#pragma once

#include <array>

#include "format/vec3.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::runtime {

/// The responses at a point of a triangle, given by its natural coordinates n_l >= 0, sum 1:
///   g(z) = sum n_l f_l^z(z),   h(rho) = sum n_l f_l^r(rho)     [Mahvash & Hayward 2005, eq. 29]
/// A view of three nodes: cheap to copy, valid while the nodes live. Evaluation is noexcept,
/// allocation-free and bounded by the number of knots.
class InterpolatedResponse {
 public:
  InterpolatedResponse(const std::array<const NodeCurves*, 3>& nodes, const Vec3& natural) noexcept
      : nodes_(nodes), natural_(natural) {}

  /// g, g', G at z; zero for z <= 0
  CurveValue normal(double z) const noexcept {
    return mix(nodes_[0]->normal().evaluate(z), nodes_[1]->normal().evaluate(z),
               nodes_[2]->normal().evaluate(z));
  }
  /// h, h', H at rho >= 0
  CurveValue lateral(double rho) const noexcept {
    return mix(nodes_[0]->lateral().evaluate(rho), nodes_[1]->lateral().evaluate(rho),
               nodes_[2]->lateral().evaluate(rho));
  }

  /// Smallest rho >= 0 with h(rho) = force, in closed form: the knots of the three curves are
  /// walked in order, and on the piece that holds the answer h is one quadratic. 0 for force <= 0;
  /// infinity when h never reaches the force (nothing can slip there).
  double lateral_inverse(double force) const noexcept;

  /// The same for a force that h reaches at `from` or before: walks down from there, hence in one
  /// or two pieces when the answer is near.
  double lateral_inverse_below(double force, double from) const noexcept;

  /// Depth beyond which at least one of the three normal responses is a continuation, m.
  double deepest() const noexcept;

  const NodeCurves& node(std::size_t l) const noexcept { return *nodes_[l]; }
  const Vec3& natural() const noexcept { return natural_; }

 private:
  CurveValue mix(const CurveValue& a, const CurveValue& b, const CurveValue& c) const noexcept {
    const auto& n = natural_;
    return {n[0] * a.force + n[1] * b.force + n[2] * c.force,
            n[0] * a.slope + n[1] * b.slope + n[2] * c.slope,
            n[0] * a.energy + n[1] * b.energy + n[2] * c.energy};
  }

  std::array<const NodeCurves*, 3> nodes_;
  Vec3 natural_;
};

}  // namespace palpate::runtime
