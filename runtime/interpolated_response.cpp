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
  double from = 0, to = kInfinity;
  for (std::size_t l = 0; l < 3; ++l) {
    for (const bool coupling : {false, true}) {
      const Found found = find(coupling ? nodes_[l]->coupling() : nodes_[l]->normal(), z);
      (coupling ? pieces.coupling : pieces.normal)[l] = found.piece;
      from = std::max(from, found.from);
      to = std::min(to, found.to);
    }
  }
  pieces.depth_from = from > 0 ? from : -kInfinity;  // out of contact all are on their first piece
  pieces.depth_to = to;
}

void InterpolatedResponse::find_lateral(double rho, PiecesInUse& pieces) const noexcept {
  double from = 0, to = kInfinity;
  for (std::size_t l = 0; l < 3; ++l) {
    const Found found = find(nodes_[l]->lateral(), rho);
    pieces.lateral[l] = found.piece;
    from = std::max(from, found.from);
    to = std::min(to, found.to);
  }
  pieces.lateral_from = from;
  pieces.lateral_to = to;
}

}  // namespace palpate::runtime
