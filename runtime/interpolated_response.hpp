// SPDX-License-Identifier: Apache-2.0
// The response between the nodes: response functions are interpolated, not forces.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "format/numbers.hpp"
#include "format/vec3.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::runtime {

/// Cache of the search for pieces: the pieces of the curves of three nodes that contain a depth and
/// a lateral deflection, and the range of both in which they do. The next evaluation mostly needs
/// the same pieces and verifies it by a few predictable comparisons.
struct PiecesInUse {
  std::array<const NodeCurves*, 3> nodes{};  ///< owners of the pieces; null: none
  std::array<const PackedPiece*, 3> normal{}, lateral{}, coupling{};
  double depth_from = 0, depth_to = 0;        ///< m, of the normal responses
  double lateral_from = 0, lateral_to = 0;    ///< m
  double coupling_from = 0, coupling_to = 0;  ///< m, of w

  bool are_of(const std::array<const NodeCurves*, 3>& these) const noexcept {
    return nodes[0] == these[0] && nodes[1] == these[1] && nodes[2] == these[2];
  }
};

/// The responses at a point of a triangle, given by its natural coordinates n_l >= 0, sum 1:
///   g(z) = sum n_l f_l^z(z),   h(rho) = sum n_l f_l^r(rho)     [Mahvash & Hayward 2005, eq. 29]
/// The lateral response of coupled responses is sum (n_l w_l) f_l^r(rho): the weights n_l w_l at
/// the depth that the contact holds, whose sum is not 1, replace the natural coordinates. A view of
/// three nodes: cheap to copy, valid while the nodes live. Evaluation is noexcept, allocation-free
/// and bounded by the number of knots.
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

  /// Weights of the three lateral responses at a depth: n_l, or n_l w_l(z).
  Vec3 lateral_weights(double z) const noexcept {
    if (!coupled()) return natural_;
    Vec3 weights;
    for (std::size_t l = 0; l < 3; ++l)
      weights[l] = natural_[l] * nodes_[l]->coupling().evaluate_from_start(z).force;
    return weights;
  }

  /// The same, of coupled responses.
  Vec3 lateral_weights(double z, PiecesInUse& pieces) const noexcept {
    if (!pieces.are_of(nodes_)) pieces = {nodes_};
    if (!(pieces.coupling_from <= z && z < pieces.coupling_to)) find_coupling(z, pieces);
    Vec3 weights;
    for (std::size_t l = 0; l < 3; ++l)
      weights[l] = natural_[l] * pieces.coupling[l]->evaluate(std::max(z, 0.0)).force;
    return weights;
  }
  /// Normal and lateral response, the lateral one with weights of its own.
  struct Decoupled {
    CurveValue normal, lateral;
  };
  Decoupled weighted_at(double z, double rho, const Vec3& weights,
                        PiecesInUse& pieces) const noexcept {
    look_up_depth(z, pieces);
    look_up_lateral(rho, pieces);
    return {z > 0 ? mix(pieces.normal, z) : CurveValue{},
            mix(weights, pieces.lateral[0]->evaluate(rho), pieces.lateral[1]->evaluate(rho),
                pieces.lateral[2]->evaluate(rho))};
  }
  /// For decoupled responses.
  Decoupled decoupled_at(double z, double rho, PiecesInUse& pieces) const noexcept {
    look_up_depth(z, pieces);
    look_up_lateral(rho, pieces);
    return {z > 0 ? mix(pieces.normal, z) : CurveValue{}, mix(pieces.lateral, rho)};
  }

  /// Smallest rho >= 0 with h(rho) = force, in closed form: the knots of the three curves are
  /// walked in order, and on the piece that contains the answer h is one quadratic. 0 for force <=
  /// 0; infinity when h never reaches the force (no slip is possible).
  double lateral_inverse(double force) const noexcept { return lateral_inverse(force, natural_); }
  double lateral_inverse(double force, const Vec3& weights) const noexcept;

  /// The same for a force that h reaches at `from` or before: walks down from there, hence in one
  /// or two pieces when the answer is near.
  double lateral_inverse_below(double force, double from, const Vec3& weights,
                               PiecesInUse& pieces) const noexcept;
  double lateral_inverse_below(double force, double from) const noexcept {
    PiecesInUse pieces;
    return lateral_inverse_below(force, from, natural_, pieces);
  }

  /// Depth beyond which at least one of the three normal responses is a continuation, m.
  double deepest() const noexcept {
    return std::min({nodes_[0]->normal().last_knot(), nodes_[1]->normal().last_knot(),
                     nodes_[2]->normal().last_knot()});
  }

  const std::array<const NodeCurves*, 3>& nodes() const noexcept { return nodes_; }
  const NodeCurves& node(std::size_t l) const noexcept { return *nodes_[l]; }
  const Vec3& natural() const noexcept { return natural_; }

 private:
  CurveValue mix(const CurveValue& a, const CurveValue& b, const CurveValue& c) const noexcept {
    return mix(natural_, a, b, c);
  }
  static CurveValue mix(const Vec3& n, const CurveValue& a, const CurveValue& b,
                        const CurveValue& c) noexcept {
    return {n[0] * a.force + n[1] * b.force + n[2] * c.force,
            n[0] * a.slope + n[1] * b.slope + n[2] * c.slope,
            n[0] * a.energy + n[1] * b.energy + n[2] * c.energy};
  }

  CurveValue mix(const std::array<const PackedPiece*, 3>& p, double d) const noexcept {
    return mix(p[0]->evaluate(d), p[1]->evaluate(d), p[2]->evaluate(d));
  }

  void look_up_depth(double z, PiecesInUse& pieces) const noexcept {
    if (!pieces.are_of(nodes_)) pieces = {nodes_};
    if (!(pieces.depth_from <= z && z < pieces.depth_to)) find_depth(z, pieces);
  }
  void look_up_lateral(double rho, PiecesInUse& pieces) const noexcept {
    if (!pieces.are_of(nodes_)) pieces = {nodes_};
    if (!(pieces.lateral_from <= rho && rho < pieces.lateral_to)) find_lateral(rho, pieces);
  }
  void find_depth(double z, PiecesInUse& pieces) const noexcept;
  void find_lateral(double rho, PiecesInUse& pieces) const noexcept;
  void find_coupling(double z, PiecesInUse& pieces) const noexcept;

  std::array<const NodeCurves*, 3> nodes_;
  Vec3 natural_;
};

}  // namespace palpate::runtime
