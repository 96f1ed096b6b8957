// SPDX-License-Identifier: Apache-2.0
// The curves of three nodes as one curve, piece by piece.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "format/numbers.hpp"
#include "runtime/interpolated_response.hpp"

namespace palpate::runtime {

/// A response on one interval between consecutive knots of the three nodes, from its start.
struct MergedPiece {
  double force = 0, slope = 0, curvature = 0;

  double force_after(double x) const noexcept { return force + x * (slope + x * curvature); }
};

inline constexpr PackedPiece kNothing;  ///< the zero response

/// x >= 0 with force + slope x + curvature x^2 = target, for target >= force, slope >= 0; written
/// so that no cancellation occurs whatever the sign of the curvature.
inline double solve_rising_quadratic(const MergedPiece& p, double target) noexcept {
  const double rise = std::max(target - p.force, 0.0);
  const double root = std::sqrt(std::max(p.slope * p.slope + 4.0 * p.curvature * rise, 0.0));
  const double denominator = p.slope + root;
  if (rise == 0.0) return 0.0;
  return denominator > 0.0 ? 2.0 * rise / denominator : kInfinity;
}

/// A weighted sum of three pieces from `start` on.
inline MergedPiece merged(const std::array<const PackedPiece*, 3>& pieces, const Vec3& weights,
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

/// A piece of this length contains the answer of an inverse: it ends at the force or above, or has
/// no end.
inline bool ends_above(const MergedPiece& p, double length, double force) noexcept {
  return !(length < kInfinity) || p.force_after(length) >= force;
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

}  // namespace palpate::runtime
