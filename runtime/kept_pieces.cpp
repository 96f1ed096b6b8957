// SPDX-License-Identifier: Apache-2.0
#include "runtime/kept_pieces.hpp"

#include "runtime/knot_merge.hpp"

namespace palpate::runtime {

/// Keeps the pieces where the knots are for a lane.
template <CurveView (NodeCurves::*kCurve)() const noexcept>
template <typename Knots>
void KeptPieces<kCurve>::keep(std::size_t lane, const Knots& knots) noexcept {
  PiecePair& on = pieces_[lane / 2];
  const std::size_t i = lane % 2;
  on.from[i] = knots.start();
  on.to[i] = knots.end();
  const std::array<const PackedPiece*, 3> pieces = knots.pieces();
  for (std::size_t l = 0; l < 3; ++l) {
    const CurveValue at = pieces[l]->evaluate(knots.start());
    Start& node = on.nodes[l];
    node.force[i] = at.force;
    node.slope[i] = at.slope;
    node.curvature[i] = pieces[l]->curvature;
    node.energy[i] = at.energy;
  }
}

template <CurveView (NodeCurves::*kCurve)() const noexcept>
void KeptPieces<kCurve>::find_all(const std::array<const NodeCurves*, 3>& nodes) noexcept {
  nodes_ = nodes;
  const InterpolatedResponse response(nodes_, natural_);
  for (std::size_t lane = 0; lane < lanes_; ++lane)
    keep(lane, KnotMerge<kCurve>(response, natural_, pieces_[lane / 2].from[lane % 2]));
}

/// To the pieces that reach forces.
template <CurveView (NodeCurves::*kCurve)() const noexcept>
void KeptPieces<kCurve>::walk(std::size_t p, Pair force) noexcept {
  const InterpolatedResponse response(nodes_, natural_);
  const Mask kept = pieces_[p].reaches(force);
  for (std::size_t i = 0; i < 2; ++i) {
    if (kept[i] != 0) continue;
    KnotMerge<kCurve> knots(response, natural_, pieces_[p].from[i]);
    walk_to(knots, force[i]);
    keep(2 * p + i, knots);
  }
  merge(pieces_[p]);
}

/// The pieces that contain deflections.
template <CurveView (NodeCurves::*kCurve)() const noexcept>
void KeptPieces<kCurve>::find(std::size_t p, Pair deflection) noexcept {
  const InterpolatedResponse response(nodes_, natural_);
  const Mask kept = pieces_[p].contains(deflection);
  for (std::size_t i = 0; i < 2; ++i)
    if (kept[i] == 0) keep(2 * p + i, KnotMerge<kCurve>(response, natural_, deflection[i]));
  merge(pieces_[p]);
}

template class KeptPieces<&NodeCurves::normal>;
template class KeptPieces<&NodeCurves::lateral>;

}  // namespace palpate::runtime
