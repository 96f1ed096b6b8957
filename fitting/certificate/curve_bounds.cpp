// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/curve_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fitting/certificate/triangle_frame.hpp"
#include "format/numbers.hpp"

namespace palpate::fitting {
namespace {

double slope_at(const runtime::CompiledCurve& curve, double d) {
  return d > 0 ? curve.slope(d) : curve.slope_at_rest();
}

/// Largest x in [0, length] with f_k + s x + c x^2 <= force, force inside the piece.
double invert_piece(const runtime::CompiledCurve::Piece& piece, double force) {
  const double rise = force - piece.force;
  if (rise <= 0) return 0;
  const double root =
      std::sqrt(std::max(0.0, piece.slope * piece.slope + 4 * piece.curvature * rise));
  const double sum = piece.slope + root;
  return sum > 0 ? 2 * rise / sum : kInfinity;
}

/// All d with f(d) = force: one value, or a plateau.
Range inverse_of(const runtime::CompiledCurve& curve, double force) {
  const auto& pieces = curve.pieces();
  if (force <= 0) {
    for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
      if (pieces[k + 1].force > 0) return {0, pieces[k].start};
    }
    return {0, pieces.back().slope > 0 ? pieces.back().start : kInfinity};
  }
  Range range{kInfinity, kInfinity};
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const double end = k + 1 < pieces.size() ? pieces[k + 1].start : kInfinity;
    const double end_force = k + 1 < pieces.size() ? pieces[k + 1].force
                             : pieces[k].slope > 0 ? kInfinity
                                                   : pieces[k].force;
    if (end_force < force) continue;
    const double d = std::min(end, pieces[k].start + invert_piece(pieces[k], force));
    if (range.low == kInfinity) range.low = d;
    range.high = end_force > force ? d : end;
    if (end_force > force) break;
  }
  return range;
}

}  // namespace

Range slope_range(const runtime::CompiledCurve& curve, const Range& range) {
  const double first = slope_at(curve, range.low), last = slope_at(curve, range.high);
  Range result{std::min(first, last), std::max(first, last)};
  for (const auto& piece : curve.pieces()) {
    if (piece.start > range.low && piece.start < range.high)
      result = hull(result, {piece.slope, piece.slope});
  }
  return result;
}

CurveTriple::CurveTriple(std::array<runtime::CompiledCurve, 3> curves,
                         const std::array<Vec3, 3>& gradient)
    : curves_(std::move(curves)), gradient_(gradient), first_knot_(kInfinity) {
  for (const auto& curve : curves_) {
    first_knot_ = std::min(first_knot_, curve.pieces().at(1).start);
  }
}

double CurveTriple::last_knot() const {
  return std::max({curves_[0].last_knot(), curves_[1].last_knot(), curves_[2].last_knot()});
}

double CurveTriple::max_slope() const {
  return std::max({curves_[0].max_slope(), curves_[1].max_slope(), curves_[2].max_slope()});
}

double CurveTriple::least_force(double d) const {
  return std::min({curves_[0].force(d), curves_[1].force(d), curves_[2].force(d)});
}

double CurveTriple::greatest_force(double d) const {
  return std::max({curves_[0].force(d), curves_[1].force(d), curves_[2].force(d)});
}

Range CurveTriple::slope(const Range& range) const {
  Range result{kInfinity, 0};
  for (const auto& curve : curves_) result = hull(result, slope_range(curve, range));
  return result;
}

std::vector<double> CurveTriple::cells(const Range& range, int parts) const {
  std::vector<double> ends{range.low, range.high};
  for (const auto& curve : curves_) {
    for (const auto& piece : curve.pieces()) {
      if (piece.start > range.low && piece.start < range.high) ends.push_back(piece.start);
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  if (ends.size() == 1) return {range.low, range.high};
  std::vector<double> cut{ends.front()};
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    for (int i = 1; i < parts; ++i) {
      cut.push_back(ends[k] + (ends[k + 1] - ends[k]) * i / parts);
    }
    cut.push_back(ends[k + 1]);
  }
  return cut;
}

double CurveTriple::cell_force_gradient(double low, double high) const {
  std::array<std::array<double, 3>, 3> b{};  // [coefficient][vertex] of a quadratic
  for (std::size_t l = 0; l < 3; ++l) {
    b[0][l] = curves_[l].force(low);
    b[1][l] = b[0][l] + 0.5 * (high - low) * slope_at(curves_[l], low);
    b[2][l] = curves_[l].force(high);
  }
  double largest = 0;
  for (const auto& v : b) largest = std::max(largest, gradient_norm(gradient_, v[0], v[1], v[2]));
  return largest;
}

double CurveTriple::cell_energy_gradient(double low, double high) const {
  std::array<std::array<double, 3>, 4> b{};  // [coefficient][vertex] of a cubic
  const double third = (high - low) / 3;
  for (std::size_t l = 0; l < 3; ++l) {
    const runtime::CurveValue start = curves_[l].evaluate(low);
    const runtime::CurveValue end = curves_[l].evaluate(high);
    b[0][l] = start.energy;
    b[1][l] = start.energy + third * start.force;
    b[2][l] = end.energy - third * end.force;
    b[3][l] = end.energy;
  }
  double largest = 0;
  for (const auto& v : b) largest = std::max(largest, gradient_norm(gradient_, v[0], v[1], v[2]));
  return largest;
}

/// On the first piece f = s d + c d^2 and E = s d^2/2 + c d^3/3. A power of d cancels in the ratio,
/// which would otherwise be 0/0 at d = 0.
double CurveTriple::first_piece_ratio(double high) const {
  std::array<double, 3> s{};
  std::array<double, 3> c{};
  for (std::size_t l = 0; l < 3; ++l) {
    s[l] = curves_[l].pieces().front().slope;
    c[l] = curves_[l].pieces().front().curvature;
  }
  const double grad_s = gradient_norm(gradient_, s[0], s[1], s[2]);
  const double grad_c = gradient_norm(gradient_, c[0], c[1], c[2]);
  const double above = grad_s * high / 2 + grad_c * high * high / 3;
  if (s[0] == 0 && s[1] == 0 && s[2] == 0) {
    const double least = std::min({c[0], c[1], c[2]});
    return grad_c == 0 ? 0 : grad_c * high / 3 / std::max(0.0, least);
  }
  // f/d is linear in d, so its smallest value is at an end.
  double least = kInfinity;
  for (std::size_t l = 0; l < 3; ++l) least = std::min({least, s[l], s[l] + c[l] * high});
  return above == 0 ? 0 : above / std::max(0.0, least);
}

double CurveTriple::force_gradient(const Range& range) const {
  const std::vector<double> ends = cells(range, 4);
  double largest = gradient_norm(gradient_, curves_[0].force(range.low),
                                 curves_[1].force(range.low), curves_[2].force(range.low));
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    largest = std::max(largest, cell_force_gradient(ends[k], ends[k + 1]));
  }
  return largest;
}

double CurveTriple::energy_ratio(const Range& range) const {
  const std::vector<double> ends = cells(range, 4);
  double largest = 0;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    if (ends[k + 1] <= first_knot_) {
      largest = std::max(largest, first_piece_ratio(ends[k + 1]));
      continue;
    }
    const double above = cell_energy_gradient(ends[k], ends[k + 1]);
    if (above > 0) largest = std::max(largest, above / least_force(ends[k]));
  }
  return largest;
}

Range CurveTriple::inverse(const std::array<double, 3>& low,
                           const std::array<double, 3>& high) const {
  Range result{kInfinity, 0};
  for (std::size_t l = 0; l < 3; ++l) {
    result.low = std::min(result.low, inverse_of(curves_[l], low[l]).low);
    result.high = std::max(result.high, inverse_of(curves_[l], high[l]).high);
  }
  return result;
}

}  // namespace palpate::fitting
