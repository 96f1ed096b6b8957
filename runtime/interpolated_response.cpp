// SPDX-License-Identifier: Apache-2.0
#include "runtime/interpolated_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpate::runtime {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void add(CurveValue& sum, double weight, const CurveValue& value) noexcept {
  sum.force += weight * value.force;
  sum.slope += weight * value.slope;
  sum.energy += weight * value.energy;
}

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

/// Walks the three knot sequences in ascending order.
class KnotMerge {
 public:
  explicit KnotMerge(const InterpolatedResponse& response) noexcept : response_(response) {}

  /// h from `start()` on, valid up to `end()`.
  MergedPiece piece() const noexcept {
    MergedPiece merged;
    for (std::size_t l = 0; l < 3; ++l) {
      const auto& pieces = response_.node(l).lateral.pieces();
      if (pieces.empty()) continue;
      const CompiledCurve::Piece& p = pieces[index_[l]];
      const double x = start_ - p.start;
      const double weight = response_.natural()[l];
      merged.force += weight * (p.force + x * (p.slope + x * p.curvature));
      merged.slope += weight * (p.slope + 2.0 * x * p.curvature);
      merged.curvature += weight * p.curvature;
    }
    return merged;
  }

  double start() const noexcept { return start_; }

  /// Next knot of any curve; infinity on the last piece.
  double end() const noexcept {
    double next = kInfinity;
    for (std::size_t l = 0; l < 3; ++l) {
      const auto& pieces = response_.node(l).lateral.pieces();
      if (index_[l] + 1 < pieces.size()) next = std::min(next, pieces[index_[l] + 1].start);
    }
    return next;
  }

  void advance() noexcept {
    start_ = end();
    for (std::size_t l = 0; l < 3; ++l) {
      const auto& pieces = response_.node(l).lateral.pieces();
      if (index_[l] + 1 < pieces.size() && pieces[index_[l] + 1].start <= start_) ++index_[l];
    }
  }

 private:
  const InterpolatedResponse& response_;
  std::array<std::size_t, 3> index_{};
  double start_ = 0;
};

}  // namespace

CurveValue InterpolatedResponse::normal(double z) const noexcept {
  CurveValue sum;
  for (std::size_t l = 0; l < 3; ++l) add(sum, natural_[l], nodes_[l]->normal.evaluate(z));
  return sum;
}

CurveValue InterpolatedResponse::lateral(double rho) const noexcept {
  CurveValue sum;
  for (std::size_t l = 0; l < 3; ++l) add(sum, natural_[l], nodes_[l]->lateral.evaluate(rho));
  return sum;
}

double InterpolatedResponse::lateral_inverse(double force) const noexcept {
  if (!(force > 0.0)) return 0.0;
  KnotMerge merge(*this);
  while (true) {
    const MergedPiece p = merge.piece();
    const double end = merge.end();
    const double length = end - merge.start();
    const bool last = !std::isfinite(end);
    if (last || p.force + length * (p.slope + length * p.curvature) >= force) {
      const double x = solve_rising_quadratic(p, force);
      return merge.start() + (last ? x : std::min(x, length));
    }
    merge.advance();
  }
}

double InterpolatedResponse::deepest() const noexcept {
  return std::min({nodes_[0]->normal.last_knot(), nodes_[1]->normal.last_knot(),
                   nodes_[2]->normal.last_knot()});
}

}  // namespace palpate::runtime
