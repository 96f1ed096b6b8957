// SPDX-License-Identifier: Apache-2.0
#include "runtime/kept_pieces.hpp"

#include "runtime/knot_merge.hpp"

namespace palpate::runtime {

/// Calls `act` with the knots of a lane, on the piece that contains a deflection.
template <std::size_t kPairs>
template <typename Act>
void KeptPieces<kPairs>::with_knots(std::size_t lane, double at, const Act& act) noexcept {
  const std::size_t i = lane == 0 ? 0 : 1;
  const Vec3 weights{weights_[0][i], weights_[1][i], weights_[2][i]};
  const InterpolatedResponse response(nodes_, weights);
  if ((lane == 0 ? first_ : other_) == ResponseOf::Depth) {
    KnotMerge<&NodeCurves::normal> knots(response, weights, at);
    act(knots);
  } else {
    KnotMerge<&NodeCurves::lateral> knots(response, weights, at);
    act(knots);
  }
}

/// Keeps the pieces where the knots are for a lane.
template <std::size_t kPairs>
template <typename Knots>
void KeptPieces<kPairs>::keep(std::size_t lane, const Knots& knots) noexcept {
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

template <std::size_t kPairs>
void KeptPieces<kPairs>::find_all(const Nodes& nodes) noexcept {
  nodes_ = nodes;
  for (std::size_t lane = 0; lane < 2 * pairs(); ++lane)
    with_knots(lane, pieces_[lane / 2].from[lane % 2],
               [&](const auto& knots) { keep(lane, knots); });
}

/// To the pieces that reach forces.
template <std::size_t kPairs>
void KeptPieces<kPairs>::walk(std::size_t p, const Pair& force) noexcept {
  const Mask kept = pieces_[p].reaches(force);
  for (std::size_t i = 0; i < 2; ++i) {
    if (kept[i] != 0) continue;
    with_knots(2 * p + i, pieces_[p].from[i], [&](auto& knots) {
      walk_to(knots, force[i]);
      keep(2 * p + i, knots);
    });
  }
  merge(pieces_[p]);
}

/// The pieces that contain deflections.
template <std::size_t kPairs>
void KeptPieces<kPairs>::find(std::size_t p, const Pair& deflection) noexcept {
  const Mask kept = pieces_[p].contains(deflection);
  for (std::size_t i = 0; i < 2; ++i) {
    if (kept[i] != 0) continue;
    with_knots(2 * p + i, deflection[i], [&](const auto& knots) { keep(2 * p + i, knots); });
  }
  merge(pieces_[p]);
}

/// Also where a force is not above 0, or a piece is not the one that reaches it.
template <std::size_t kPairs>
ReachedForces KeptPieces<kPairs>::reach_elsewhere(std::size_t p, Pair force) noexcept {
  PiecePair& on = pieces_[p];
  const Merged& q = on.merged;
  if (!all(on.reaches(force))) walk(p, force);
  const Pair rise = larger(force - q.force, Pair{});
  const Pair root = roots(larger(on.square(rise), Pair{}));
  const Pair rising = rise / larger(q.half_slope + root, Pair{});  // infinite on a plateau
  const Pair x = smaller(rise > Pair{} ? rising : Pair{}, on.to - on.from);
  ReachedForces reached = q.after(x, on.from + x);
  reached.energy = x < both(kInfinity) ? reached.energy : both(-kInfinity);
  return reached.where(force > Pair{});
}

/// Also where a deflection is not above 0, or a piece does not contain it.
template <std::size_t kPairs>
ReachedForces KeptPieces<kPairs>::evaluate_elsewhere(std::size_t p, Pair deflection) noexcept {
  PiecePair& on = pieces_[p];
  if (!all(on.contains(deflection))) find(p, deflection);
  return on.merged.after(deflection - on.from, deflection).where(deflection > Pair{});
}

template class KeptPieces<Lanes::kPairs>;
template class KeptPieces<1>;

}  // namespace palpate::runtime
