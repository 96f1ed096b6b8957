// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/straight_press.hpp"

#include <algorithm>
#include <vector>

#include "fitting/response/leaning_response.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::report {

namespace {

constexpr int kEvenKnots = 32;
constexpr double kDifference = 1e-3;  ///< of the last knot, for slopes
constexpr double kTouch = 1e-3;       ///< of that difference

/// The knots of a curve and evenly spread ones between its ends.
std::vector<float> denser(const std::vector<float>& knots) {
  std::vector<float> all = knots;
  for (int k = 1; k < kEvenKnots; ++k)
    all.push_back(knots.back() * static_cast<float>(k) / kEvenKnots);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

ResponseCurve straight_press(const NodeResponse& node, ResponseKind kind) {
  if (node.status == ResponseStatus::Hole || norm(vec3_of(node.lean)) == 0) return node.normal;
  const fitting::LeaningResponse leaning(node, kind);
  const runtime::CompiledCurve g(node.normal);
  ResponseCurve press;
  press.knot = denser(node.normal.knot);
  const double step = kDifference * static_cast<double>(press.knot.back());
  for (const float knot : press.knot) {
    const double z = static_cast<double>(knot), from = std::max(0.0, z - step), to = z + step;
    const double added = (leaning.normal_force(to) - leaning.normal_force(from)) / (to - from);
    const double own = g.evaluate(std::max(z, kTouch * step)).slope;  // at 0 nothing is touched
    press.slope.push_back(static_cast<float>(own + added));
  }
  return press;
}

}  // namespace palpate::report
