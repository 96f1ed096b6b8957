// SPDX-License-Identifier: Apache-2.0
#include "runtime/interpolated_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "format/numbers.hpp"
#include "runtime/knot_merge.hpp"

namespace palpate::runtime {
namespace {

/// The piece that contains a deflection, and its range.
struct Found {
  const PackedPiece* piece = &kNothing;
  double from = 0, to = kInfinity;
};
Found find(const CurveView& curve, double d) noexcept {
  if (curve.size() == 0) return {};
  const std::size_t k = curve.piece_at(d);
  return {&curve.piece(k), curve.start(k), k + 1 < curve.size() ? curve.start(k + 1) : kInfinity};
}

/// Where curves have no knot.
struct Range {
  double from = 0, to = kInfinity;
};
/// The pieces of one of the curves of three nodes.
template <CurveView (NodeCurves::*kCurve)() const noexcept>
Range find_pieces(const std::array<const NodeCurves*, 3>& nodes, double d,
                  std::array<const PackedPiece*, 3>& pieces) noexcept {
  Range range;
  for (std::size_t l = 0; l < 3; ++l) {
    const Found found = find((nodes[l]->*kCurve)(), d);
    pieces[l] = found.piece;
    range.from = std::max(range.from, found.from);
    range.to = std::min(range.to, found.to);
  }
  return range;
}

using LateralKnots = KnotMerge<&NodeCurves::lateral>;

}  // namespace

double InterpolatedResponse::lateral_inverse(double force, const Vec3& weights) const noexcept {
  if (!(force > 0.0)) return 0.0;
  LateralKnots knots(*this, weights);
  return inverse_from(knots, force);
}

double InterpolatedResponse::lateral_inverse_below(double force, double from, const Vec3& weights,
                                                   PiecesInUse& pieces) const noexcept {
  if (!(force > 0.0)) return 0.0;
  look_up_lateral(from, pieces);
  const MergedPiece here = merged(pieces.lateral, weights, pieces.lateral_from);
  if (here.force < force || !(pieces.lateral_from > 0)) {
    return std::min(pieces.lateral_from + solve_rising_quadratic(here, force), from);
  }
  LateralKnots merge(*this, weights, from);
  double end = from;
  while (true) {
    const MergedPiece p = merge.piece();
    if (p.force < force || merge.at_first()) {
      return std::min(merge.start() + solve_rising_quadratic(p, force), end);
    }
    end = merge.start();
    merge.retreat();
  }
}

void InterpolatedResponse::find_depth(double z, PiecesInUse& pieces) const noexcept {
  const Range range = find_pieces<&NodeCurves::normal>(nodes_, z, pieces.normal);
  // Out of contact all are on their first piece.
  pieces.depth_from = range.from > 0 ? range.from : -kInfinity;
  pieces.depth_to = range.to;
}

void InterpolatedResponse::find_lateral(double rho, PiecesInUse& pieces) const noexcept {
  const Range range = find_pieces<&NodeCurves::lateral>(nodes_, rho, pieces.lateral);
  pieces.lateral_from = range.from;
  pieces.lateral_to = range.to;
}

void InterpolatedResponse::find_coupling(double z, PiecesInUse& pieces) const noexcept {
  const Range range = find_pieces<&NodeCurves::coupling>(nodes_, z, pieces.coupling);
  pieces.coupling_from = range.from > 0 ? range.from : -kInfinity;
  pieces.coupling_to = range.to;
}

}  // namespace palpate::runtime
