// SPDX-License-Identifier: Apache-2.0
#include "runtime/interpolated_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "format/numbers.hpp"

namespace palpate::runtime {
namespace {

/// h on one interval between consecutive knots of the merged sequence.
struct MergedPiece {
  double force = 0, slope = 0, curvature = 0;
};

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

constexpr PackedPiece kNothing;  // the zero response

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

  /// h from `start()` on, valid up to `end()`.
  MergedPiece piece() const noexcept {
    std::array<const PackedPiece*, 3> pieces;
    for (std::size_t l = 0; l < 3; ++l) {
      const CurveView view = curve(l);
      pieces[l] = view.size() == 0 ? &kNothing : &view.piece(index_[l]);
    }
    return merged(pieces, weights_, start_);
  }

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

  /// The piece contains the answer of an inverse: it ends at the force or above, or has no end.
  bool reaches(const MergedPiece& p, double force) const noexcept {
    const double length = end() - start_;
    return !std::isfinite(length) || p.force + length * (p.slope + length * p.curvature) >= force;
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
using NormalKnots = KnotMerge<&NodeCurves::normal>;

/// The deflection at which the force is reached, on the piece that reaches it or after.
template <typename Knots>
double inverse_from(Knots& knots, double force) noexcept {
  MergedPiece p = knots.piece();
  for (; !knots.reaches(p, force); p = knots.piece()) knots.advance();
  return knots.start() + std::min(solve_rising_quadratic(p, force), knots.end() - knots.start());
}

/// The smallest such deflection, from any piece.
template <typename Knots>
double inverse_near(Knots& knots, double force) noexcept {
  while (knots.piece().force >= force && !knots.at_first()) knots.retreat();
  return inverse_from(knots, force);
}

}  // namespace

double InterpolatedResponse::lateral_inverse(double force, const Vec3& weights) const noexcept {
  if (!(force > 0.0)) return 0.0;
  LateralKnots knots(*this, weights);
  return inverse_from(knots, force);
}

double InterpolatedResponse::normal_inverse(double force, double from) const noexcept {
  if (!(force > 0.0)) return 0.0;
  NormalKnots knots(*this, natural_, from);
  return inverse_near(knots, force);
}

double InterpolatedResponse::lateral_inverse(double force, double from) const noexcept {
  if (!(force > 0.0)) return 0.0;
  LateralKnots knots(*this, natural_, from);
  return inverse_near(knots, force);
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
