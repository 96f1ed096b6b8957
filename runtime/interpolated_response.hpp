// SPDX-License-Identifier: Apache-2.0
// The response between the nodes: response functions are interpolated, not forces.
#pragma once

#include <array>

#include "format/vec3.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::runtime {

/// The responses at a point of a triangle, given by its natural coordinates n_l >= 0, sum 1:
///   g(z) = sum n_l f_l^z(z),   h(rho) = sum n_l f_l^r(rho)     [Mahvash & Hayward 2005, eq. 29]
/// Coupled responses are interpolated as potentials,
///   E(z, rho) = sum n_l (G_l(z) + w_l(z) H_l(rho)),
/// which is the same with w_l = 1. At a depth their lateral response is sum (n_l w_l) f_l^r(rho):
/// the natural coordinates give way to the weights n_l w_l, whose sum is not 1. A view of three
/// nodes: cheap to copy, valid while the nodes live. Evaluation is noexcept, allocation-free and
/// bounded by the number of knots.
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

  bool coupled() const noexcept { return nodes_[0]->coupled(); }

  /// What the three lateral responses count for at a depth: n_l, or n_l w_l(z).
  Vec3 lateral_weights(double z) const noexcept {
    if (!coupled()) return natural_;
    Vec3 weights;
    for (std::size_t l = 0; l < 3; ++l)
      weights[l] = natural_[l] * nodes_[l]->coupling().evaluate_from_start(z).force;
    return weights;
  }

  /// What coupled responses are at a depth, whatever the lateral deflection.
  struct AtDepth {
    double grip = 0;    ///< g, N
    double energy = 0;  ///< sum n_l G_l, J
    Vec3 weights{};     ///< n_l w_l
    Vec3 rates{};       ///< n_l w_l', 1/m
  };
  AtDepth at_depth(double z) const noexcept {
    AtDepth at;
    for (std::size_t l = 0; l < 3; ++l) {
      const CurveValue g = nodes_[l]->normal().evaluate(z);
      const CurveValue w = nodes_[l]->coupling().evaluate_from_start(z);
      at.grip += natural_[l] * g.force;
      at.energy += natural_[l] * g.energy;
      at.weights[l] = natural_[l] * w.force;
      at.rates[l] = natural_[l] * w.slope;
    }
    return at;
  }

  /// Forces and energy of coupled responses, the gradient of one potential.
  struct CoupledValue {
    double normal = 0;   ///< dE/dz = g + sum n_l w_l' H_l, N
    double lateral = 0;  ///< dE/drho = sum n_l w_l h_l, N
    double energy = 0;   ///< J
  };
  CoupledValue coupled_at(const AtDepth& at, double rho) const noexcept {
    CoupledValue value{at.grip, 0, at.energy};
    for (std::size_t l = 0; l < 3; ++l) {
      const CurveValue h = nodes_[l]->lateral().evaluate(rho);
      value.normal += at.rates[l] * h.energy;
      value.lateral += at.weights[l] * h.force;
      value.energy += at.weights[l] * h.energy;
    }
    return value;
  }

  /// Smallest rho >= 0 with h(rho) = force, in closed form: the knots of the three curves are
  /// walked in order, and on the piece that holds the answer h is one quadratic. 0 for force <= 0;
  /// infinity when h never reaches the force (nothing can slip there).
  double lateral_inverse(double force) const noexcept { return lateral_inverse(force, natural_); }
  double lateral_inverse(double force, const Vec3& weights) const noexcept;

  /// The same for a force that h reaches at `from` or before: walks down from there, hence in one
  /// or two pieces when the answer is near.
  double lateral_inverse_below(double force, double from, const Vec3& weights) const noexcept;
  double lateral_inverse_below(double force, double from) const noexcept {
    return lateral_inverse_below(force, from, natural_);
  }

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
