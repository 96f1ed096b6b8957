// SPDX-License-Identifier: Apache-2.0
#include "runtime/kept_pieces.hpp"

#include "runtime/knot_merge.hpp"

namespace palpate::runtime {
namespace {

constexpr Pair kZero{};

void set(Pair& pair, std::size_t i, double x) noexcept {
  pair[i] = x;
}

}  // namespace

template <CurveView (NodeCurves::*kCurve)() const noexcept>
void KeptPieces<kCurve>::merge(PiecePair& pieces) const noexcept {
  const auto weighted = [&](Pair Start::*of) {
    Pair sum = both(natural_[0]) * (pieces.nodes[0].*of);
    sum += both(natural_[1]) * (pieces.nodes[1].*of);
    sum += both(natural_[2]) * (pieces.nodes[2].*of);
    return sum;
  };
  Start& sum = pieces.merged;
  sum = {weighted(&Start::force), weighted(&Start::slope), weighted(&Start::curvature),
         weighted(&Start::energy)};
  const Pair length = pieces.to - pieces.from;
  const Pair end = sum.force + length * (sum.slope + length * sum.curvature);
  pieces.end_force = length < both(kInfinity) ? end : both(kInfinity);
}

/// Keeps the pieces where the knots are for a lane.
template <CurveView (NodeCurves::*kCurve)() const noexcept>
template <typename Knots>
void KeptPieces<kCurve>::keep(std::size_t lane, const Knots& knots) noexcept {
  PiecePair& pieces = pieces_[lane / 2];
  const std::size_t i = lane % 2;
  set(pieces.from, i, knots.start());
  set(pieces.to, i, knots.end());
  const std::array<const PackedPiece*, 3> at = knots.pieces();
  for (std::size_t l = 0; l < 3; ++l) {
    const CurveValue value = at[l]->evaluate(knots.start());
    Start& node = pieces.nodes[l];
    set(node.force, i, value.force);
    set(node.slope, i, value.slope);
    set(node.curvature, i, at[l]->curvature);
    set(node.energy, i, value.energy);
  }
}

template <CurveView (NodeCurves::*kCurve)() const noexcept>
void KeptPieces<kCurve>::find_all(const InterpolatedResponse& response) noexcept {
  for (std::size_t lane = 0; lane < 2 * pairs_; ++lane)
    keep(lane, KnotMerge<kCurve>(response, natural_, pieces_[lane / 2].from[lane % 2]));
}

/// Makes the pieces those of a response.
template <CurveView (NodeCurves::*kCurve)() const noexcept>
void KeptPieces<kCurve>::keep_for(const InterpolatedResponse& response) noexcept {
  const bool same_nodes = nodes_ == response.nodes();
  if (same_nodes && natural_ == response.natural()) return;
  natural_ = response.natural();
  if (!same_nodes) {
    nodes_ = response.nodes();
    find_all(response);
  }
  for (std::size_t p = 0; p < pairs_; ++p) merge(pieces_[p]);
}

template <CurveView (NodeCurves::*kCurve)() const noexcept>
void KeptPieces<kCurve>::reach(const InterpolatedResponse& response, const Lanes& forces,
                               ReachedForces& at) noexcept {
  keep_for(response);
  for (std::size_t p = 0; p < pairs_; ++p) {
    PiecePair& pieces = pieces_[p];
    const Pair& force = forces.pair[p];
    const Mask begins_below = (pieces.merged.force < force) | (pieces.from <= kZero);
    const Mask kept = (force <= kZero) | (begins_below & (pieces.end_force >= force));
    if (!all(kept)) {
      for (std::size_t i = 0; i < 2; ++i) {
        if (kept[i] != 0) continue;
        KnotMerge<kCurve> knots(response, natural_, pieces.from[i]);
        walk_to(knots, force[i]);
        keep(2 * p + i, knots);
      }
      merge(pieces);
    }
    const Start& q = pieces.merged;
    const Pair rise = larger(force - q.force, kZero);
    const Pair root = roots(larger(q.slope * q.slope + 4.0 * q.curvature * rise, kZero));
    const Pair denominator = q.slope + root;
    Pair x = denominator > kZero ? 2.0 * rise / denominator : both(kInfinity);
    x = rise == kZero ? kZero : x;
    x = smaller(x, pieces.to - pieces.from);
    const Mask presses = force > kZero;
    at.deflection.pair[p] = presses ? pieces.from + x : kZero;
    at.force.pair[p] = presses ? q.force + x * (q.slope + x * q.curvature) : kZero;
    at.energy.pair[p] =
        presses ? q.energy + x * (q.force + x * (q.slope / 2.0 + x * (q.curvature * kThird)))
                : kZero;
  }
}

template <CurveView (NodeCurves::*kCurve)() const noexcept>
void KeptPieces<kCurve>::evaluate(const InterpolatedResponse& response, const Lanes& deflections,
                                  ReachedForces& at) noexcept {
  keep_for(response);
  for (std::size_t p = 0; p < pairs_; ++p) {
    PiecePair& pieces = pieces_[p];
    const Pair& d = deflections.pair[p];
    const Mask kept = (d <= kZero) | ((pieces.from <= d) & (d < pieces.to));
    if (!all(kept)) {
      for (std::size_t i = 0; i < 2; ++i)
        if (kept[i] == 0) keep(2 * p + i, KnotMerge<kCurve>(response, natural_, d[i]));
      merge(pieces);
    }
    const Start& q = pieces.merged;
    const Pair x = d - pieces.from;
    const Mask presses = d > kZero;
    at.deflection.pair[p] = presses ? d : kZero;
    at.force.pair[p] = presses ? q.force + x * (q.slope + x * q.curvature) : kZero;
    at.energy.pair[p] =
        presses ? q.energy + x * (q.force + x * (q.slope / 2.0 + x * (q.curvature * kThird)))
                : kZero;
  }
}

template class KeptPieces<&NodeCurves::normal>;
template class KeptPieces<&NodeCurves::lateral>;

}  // namespace palpate::runtime
