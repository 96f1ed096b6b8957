// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/soften.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "fitting/measurement/nearest_rank.hpp"
#include "format/error.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr int kBisections = 14;        // relative resolution of the slope limit: 1e-4
constexpr double kMinFraction = 0.01;  // of the largest slope; below it the body is unrecognisable

double largest_slope(const Library& library) {
  float largest = 0;
  for (const NodeResponse& node : library.responses) {
    for (const ResponseCurve* curve : {&node.normal, &node.lateral}) {
      for (const float slope : curve->slope) largest = std::max(largest, slope);
    }
  }
  return static_cast<double>(largest);
}

Library with_slopes_limited(const Library& library, double max_slope) {
  Library soft = library;
  const auto limit = static_cast<float>(max_slope);
  for (NodeResponse& node : soft.responses) {
    for (ResponseCurve* curve : {&node.normal, &node.lateral}) {
      for (float& slope : curve->slope) slope = std::min(slope, limit);
    }
  }
  return soft;
}

/// Fraction of the force at its last knot that a curve has lost.
double force_loss(const ResponseCurve& before, const ResponseCurve& after) {
  const runtime::CompiledCurve original(before), softened(after);
  const double end = original.last_knot();
  return original.force(end) > 0 ? 1 - softened.force(end) / original.force(end) : 0;
}

Softening summarize(const Library& before, const Library& after, double max_slope) {
  Softening result;
  result.max_slope = max_slope;
  std::vector<double> losses;
  for (std::size_t v = 0; v < before.responses.size(); ++v) {
    const NodeResponse& original = before.responses[v];
    const NodeResponse& softened = after.responses[v];
    if (original.status == ResponseStatus::Hole) continue;
    losses.push_back(force_loss(original.normal, softened.normal));
    losses.push_back(force_loss(original.lateral, softened.lateral));
  }
  std::sort(losses.begin(), losses.end());
  result.curves = static_cast<std::size_t>(
      std::count_if(losses.begin(), losses.end(), [](double loss) { return loss > 0; }));
  result.median = losses[nearest_rank(losses.size(), 0.5)];
  result.p95 = losses[nearest_rank(losses.size(), 0.95)];
  result.worst = losses.back();
  return result;
}

}  // namespace

Softening soften(Library& library, const CertifySettings& settings, double bound) {
  certify(library, settings);
  if (certified_lipschitz_bound(library.certificate) <= bound) return {};
  CertifySettings enforcing = settings;
  enforcing.enforced_bound = bound;
  const auto is_certified = [&](Library& candidate) {
    certify(candidate, enforcing);
    return candidate.certificate.min_lipschitz_bound <= bound;
  };
  if (is_certified(library)) return {};
  const double steepest = largest_slope(library);
  double low = kMinFraction * steepest, high = steepest;
  Library best = with_slopes_limited(library, low);
  if (!is_certified(best)) {
    throw Error(ErrorKind::Configuration, "library '" + library.name + "'",
                "no softening certifies it for " + std::to_string(bound) +
                    " N/m: with its slopes limited to a hundredth of the largest, the smallest "
                    "enforceable bound is " +
                    std::to_string(best.certificate.min_lipschitz_bound) + " N/m",
                "raise the rate, or choose a device with more damping");
  }
  for (int i = 0; i < kBisections; ++i) {
    const double max_slope = 0.5 * (low + high);
    Library candidate = with_slopes_limited(library, max_slope);
    if (is_certified(candidate)) {
      low = max_slope;
      best = std::move(candidate);
    } else {
      high = max_slope;
    }
  }
  const Softening result = summarize(library, best, low);
  library = std::move(best);
  return result;
}

}  // namespace palpate::fitting
