// SPDX-License-Identifier: Apache-2.0
#include "runtime/response_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "format/error.hpp"

namespace palpate::runtime {
namespace {

[[noreturn]] void reject(const std::string& problem) {
  throw Error(ErrorKind::Configuration, "response curve", problem, "fit the curves again");
}

void check(const ResponseCurve& curve) {
  if (curve.knot.size() < 2 || curve.knot.size() != curve.slope.size()) {
    reject("needs at least two knots and one slope per knot");
  }
  if (curve.knot[0] != 0.0F) reject("the first knot is not 0");
  for (std::size_t k = 0; k < curve.knot.size(); ++k) {
    if (!std::isfinite(curve.knot[k]) || (k > 0 && !(curve.knot[k] > curve.knot[k - 1]))) {
      reject("knot " + std::to_string(k) + " does not increase");
    }
    if (!std::isfinite(curve.slope[k]) || curve.slope[k] < 0.0F) {
      reject("slope " + std::to_string(k) + " is negative or not finite");
    }
  }
}

CurveValue on_piece(const CompiledCurve::Piece& p, double d) noexcept {
  const double x = d - p.start;
  return {p.force + x * (p.slope + x * p.curvature), p.slope + 2.0 * x * p.curvature,
          p.energy + x * (p.force + x * (p.slope / 2.0 + x * (p.curvature * kThird)))};
}

}  // namespace

CompiledCurve::CompiledCurve(const ResponseCurve& curve) : CompiledCurve(curve, 0) {}

CompiledCurve::CompiledCurve(const ResponseCurve& curve, double start) {
  check(curve);
  const std::size_t knots = curve.knot.size();
  pieces_.resize(knots);
  pieces_[0].force = start;
  for (std::size_t k = 0; k < knots; ++k) {
    Piece& p = pieces_[k];
    p.start = static_cast<double>(curve.knot[k]);
    p.slope = static_cast<double>(curve.slope[k]);
    max_slope_ = std::max(max_slope_, p.slope);
    if (k > 0) {
      Piece& before = pieces_[k - 1];
      before.curvature = (p.slope - before.slope) / (2.0 * (p.start - before.start));
      const CurveValue joint = on_piece(before, p.start);
      p.force = joint.force;
      p.energy = joint.energy;
    }
  }
}

CurveValue CompiledCurve::evaluate(double d) const noexcept {
  if (pieces_.empty() || !(d > 0.0)) return {};
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), d,
                                      [](double value, const Piece& p) { return value < p.start; });
  return on_piece(*(after - 1), d);
}

std::size_t NodeCurves::lines(const CurveSizes& sizes) noexcept {
  return knot_lines(sizes) + (sizes.sum() + kPiecesALine - 1) / kPiecesALine;
}

NodeCurves NodeCurves::write(CacheLine* memory, const CompiledCurve& normal,
                             const CompiledCurve& lateral, const CompiledCurve& coupling) noexcept {
  const auto size = [](const CompiledCurve& c) {
    return static_cast<std::uint16_t>(c.pieces().size());
  };
  const CurveSizes sizes{size(normal), size(lateral), size(coupling)};
  auto* knots = reinterpret_cast<float*>(memory);
  auto* pieces = reinterpret_cast<PackedPiece*>(memory + knot_lines(sizes));
  for (const CompiledCurve* curve : {&normal, &lateral, &coupling}) {
    for (const CompiledCurve::Piece& piece : curve->pieces()) {
      *pieces = pack(piece);
      *knots++ = pieces++->start;
    }
  }
  return {memory, sizes};
}

NodeCurves::InUse NodeCurves::in_use(double depth, double lateral_deflection) const noexcept {
  const auto line = [&](std::size_t first, const CurveView& curve, double at) {
    return knot_lines(sizes_) + (first + curve.piece_at(at)) / kPiecesALine;
  };
  return {knot_lines(sizes_), line(0, normal(), depth),
          line(sizes_.normal, lateral(), lateral_deflection),
          coupled() ? line(std::size_t{sizes_.normal} + sizes_.lateral, coupling(), depth) : 0};
}

PackedPiece pack(const CompiledCurve::Piece& p) noexcept {
  return {static_cast<float>(p.start), static_cast<float>(p.slope), p.curvature, p.force, p.energy};
}

}  // namespace palpate::runtime
