// SPDX-License-Identifier: Apache-2.0
#include "runtime/interpolated_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "format/numbers.hpp"

namespace palpate::runtime {
namespace {

/// x >= 0 with force + slope x + curvature x^2 = target, for target >= force, slope >= 0; written
/// so that no cancellation occurs whatever the sign of the curvature.
double solve_rising_quadratic(const MergedPiece& p, double target) noexcept {
  const double rise = std::max(target - p.force, 0.0);
  const double root = std::sqrt(std::max(p.slope * p.slope + 4.0 * p.curvature * rise, 0.0));
  const double denominator = p.slope + root;
  if (rise == 0.0) return 0.0;
  return denominator > 0.0 ? 2.0 * rise / denominator : kInfinity;
}

/// h from `start` on, while it is on these pieces.
MergedPiece merged(const std::array<const PackedPiece*, 3>& pieces, const Vec3& weights,
                   double start) noexcept {
  MergedPiece sum;
  for (std::size_t l = 0; l < 3; ++l) {
    const PackedPiece& p = *pieces[l];
    const double slope = static_cast<double>(p.slope);
    const double x = start - static_cast<double>(p.start);
    sum.force += weights[l] * (p.force + x * (slope + x * p.curvature));
    sum.slope += weights[l] * (slope + 2.0 * x * p.curvature);
    sum.curvature += weights[l] * p.curvature;
  }
  return sum;
}

/// Its energy at `start`.
double merged_energy(const std::array<const PackedPiece*, 3>& pieces, const Vec3& weights,
                     double start) noexcept {
  double sum = 0;
  for (std::size_t l = 0; l < 3; ++l) sum += weights[l] * pieces[l]->evaluate(start).energy;
  return sum;
}

constexpr PackedPiece kNothing;  // the zero response

/// A piece of this length contains the answer of an inverse: it ends at the force or above, or has
/// no end.
bool ends_above(const MergedPiece& p, double length, double force) noexcept {
  return !(length < kInfinity) || p.force_after(length) >= force;
}

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

/// Walks the three knot sequences of one kind of curve in ascending order.
template <CurveView (NodeCurves::*kCurve)() const noexcept>
class KnotMerge {
 public:
  KnotMerge(const InterpolatedResponse& response, const Vec3& weights) noexcept
      : response_(response), weights_(weights) {}
  /// On the piece that contains `at`.
  KnotMerge(const InterpolatedResponse& response, const Vec3& weights, double at) noexcept
      : response_(response), weights_(weights) {
    for (std::size_t l = 0; l < 3; ++l) index_[l] = curve(l).piece_at(at);
    start_ = last_start();
  }

  std::array<const PackedPiece*, 3> pieces() const noexcept {
    std::array<const PackedPiece*, 3> pieces;
    for (std::size_t l = 0; l < 3; ++l) {
      const CurveView view = curve(l);
      pieces[l] = view.size() == 0 ? &kNothing : &view.piece(index_[l]);
    }
    return pieces;
  }

  /// The response from `start()` on, valid up to `end()`.
  MergedPiece piece() const noexcept { return merged(pieces(), weights_, start_); }

  double start() const noexcept { return start_; }

  /// Next knot of any curve; infinity on the last piece.
  double end() const noexcept {
    double next = kInfinity;
    for (std::size_t l = 0; l < 3; ++l) {
      const CurveView view = curve(l);
      if (index_[l] + 1 < view.size()) next = std::min(next, view.start(index_[l] + 1));
    }
    return next;
  }

  void advance() noexcept {
    start_ = end();
    for (std::size_t l = 0; l < 3; ++l) {
      const CurveView view = curve(l);
      if (index_[l] + 1 < view.size() && view.start(index_[l] + 1) <= start_) ++index_[l];
    }
  }

  bool reaches(const MergedPiece& p, double force) const noexcept {
    return ends_above(p, end() - start_, force);
  }

  bool at_first() const noexcept { return !(start_ > 0); }

  /// To the piece before; not allowed from the first.
  void retreat() noexcept {
    for (std::size_t l = 0; l < 3; ++l) {
      const CurveView view = curve(l);
      if (index_[l] > 0 && view.start(index_[l]) >= start_) --index_[l];
    }
    start_ = last_start();
  }

 private:
  CurveView curve(std::size_t l) const noexcept { return (response_.node(l).*kCurve)(); }
  /// Where the merged piece begins: the last of the starts of the three.
  double last_start() const noexcept {
    double start = 0;
    for (std::size_t l = 0; l < 3; ++l) {
      const CurveView view = curve(l);
      if (view.size() > 0) start = std::max(start, view.start(index_[l]));
    }
    return start;
  }

  const InterpolatedResponse& response_;
  Vec3 weights_;
  std::array<std::size_t, 3> index_{};
  double start_ = 0;
};

using LateralKnots = KnotMerge<&NodeCurves::lateral>;

/// Advances to the piece that reaches the force.
template <typename Knots>
MergedPiece advance_to(Knots& knots, double force) noexcept {
  MergedPiece p = knots.piece();
  for (; !knots.reaches(p, force); p = knots.piece()) knots.advance();
  return p;
}

/// The deflection at which the force is reached, on the piece that reaches it or after.
template <typename Knots>
double inverse_from(Knots& knots, double force) noexcept {
  const MergedPiece p = advance_to(knots, force);
  return knots.start() + std::min(solve_rising_quadratic(p, force), knots.end() - knots.start());
}

/// Walks from any piece to the first that reaches the force.
template <typename Knots>
MergedPiece walk_to(Knots& knots, double force) noexcept {
  while (knots.piece().force >= force && !knots.at_first()) knots.retreat();
  return advance_to(knots, force);
}

/// Merges the kept pieces of the nodes at a point.
void merge(const Vec3& natural, KeptPiece& kept) noexcept {
  kept.natural = natural;
  kept.merged = merged(kept.pieces, natural, kept.from);
  kept.energy = merged_energy(kept.pieces, natural, kept.from);
  kept.end_force = kept.to < kInfinity ? kept.merged.force_after(kept.to - kept.from) : kInfinity;
}

/// Keeps the piece where the knots are.
template <typename Knots>
void keep(const InterpolatedResponse& response, const Knots& knots, KeptPiece& kept) noexcept {
  kept.nodes = response.nodes();
  kept.pieces = knots.pieces();
  kept.from = knots.start();
  kept.to = knots.end();
  merge(response.natural(), kept);
}

template <CurveView (NodeCurves::*kCurve)() const noexcept>
void keep_at(const InterpolatedResponse& response, double at, KeptPiece& kept) noexcept {
  keep(response, KnotMerge<kCurve>(response, response.natural(), at), kept);
}

/// Keeps the piece that reaches the force.
template <CurveView (NodeCurves::*kCurve)() const noexcept>
void keep_force(const InterpolatedResponse& response, double force, KeptPiece& kept) noexcept {
  if (!kept.is_of(response.nodes())) {
    keep_at<kCurve>(response, kept.from, kept);
  } else if (!kept.is_at(response.natural())) {
    merge(response.natural(), kept);
  }
  const bool begins_below = kept.merged.force < force || !(kept.from > 0);
  if (begins_below && kept.end_force >= force) return;
  KnotMerge<kCurve> knots(response, response.natural(), kept.from);
  walk_to(knots, force);
  keep(response, knots, kept);
}

/// Force and energy a length x after the start of a piece.
ReachedForce value_after(const KeptPiece& kept, double x) noexcept {
  return {kept.from + x, kept.merged.force_after(x), kept.energy + kept.merged.work_after(x)};
}

template <CurveView (NodeCurves::*kCurve)() const noexcept>
ReachedForce reach(const InterpolatedResponse& response, double force, KeptPiece& kept) noexcept {
  if (!(force > 0)) return {};
  keep_force<kCurve>(response, force, kept);
  const double x = std::min(solve_rising_quadratic(kept.merged, force), kept.to - kept.from);
  if (!(x < kInfinity)) return {kInfinity, force, kInfinity};
  return value_after(kept, x);
}

}  // namespace

double InterpolatedResponse::lateral_inverse(double force, const Vec3& weights) const noexcept {
  if (!(force > 0.0)) return 0.0;
  LateralKnots knots(*this, weights);
  return inverse_from(knots, force);
}

double InterpolatedResponse::lateral_inverse(double force, double from,
                                             PiecesInUse& pieces) const noexcept {
  if (!(force > 0.0)) return 0.0;
  look_up_lateral(from, pieces);
  const MergedPiece here = merged(pieces.lateral, natural_, pieces.lateral_from);
  const double length = pieces.lateral_to - pieces.lateral_from;
  const bool begins_below = here.force < force || !(pieces.lateral_from > 0);
  if (begins_below && ends_above(here, length, force))
    return pieces.lateral_from + std::min(solve_rising_quadratic(here, force), length);
  LateralKnots knots(*this, natural_, from);
  const MergedPiece p = walk_to(knots, force);
  return knots.start() + std::min(solve_rising_quadratic(p, force), knots.end() - knots.start());
}

ReachedForce InterpolatedResponse::normal_reach(double force, KeptPiece& kept) const noexcept {
  return reach<&NodeCurves::normal>(*this, force, kept);
}

ReachedForce InterpolatedResponse::lateral_reach(double force, KeptPiece& kept) const noexcept {
  return reach<&NodeCurves::lateral>(*this, force, kept);
}

ReachedForce InterpolatedResponse::lateral_at(double rho, KeptPiece& kept) const noexcept {
  if (!kept.is_of(nodes_) || !(kept.from <= rho && rho < kept.to)) {
    keep_at<&NodeCurves::lateral>(*this, rho, kept);
  } else if (!kept.is_at(natural_)) {
    merge(natural_, kept);
  }
  return value_after(kept, rho - kept.from);
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
