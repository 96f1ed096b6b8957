// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <string>

#include "fitting/fitting.hpp"
#include "fitting/measurement/nearest_rank.hpp"
#include "format/error.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr int kHalvings = 14;         // of the cap: to a ten-thousandth
constexpr double kLeastShare = 0.01;  // of the steepest slope: a softer body is no likeness

double steepest_slope(const Library& library) {
  float steepest = 0;
  for (const NodeResponse& node : library.responses) {
    for (const ResponseCurve* curve : {&node.normal, &node.lateral}) {
      for (const float slope : curve->slope) steepest = std::max(steepest, slope);
    }
  }
  return static_cast<double>(steepest);
}

Library capped(const Library& library, double cap) {
  Library soft = library;
  const auto limit = static_cast<float>(cap);
  for (NodeResponse& node : soft.responses) {
    for (ResponseCurve* curve : {&node.normal, &node.lateral}) {
      for (float& slope : curve->slope) slope = std::min(slope, limit);
    }
  }
  return soft;
}

/// Share of the force at its last knot that a curve has lost.
double lost(const ResponseCurve& before, const ResponseCurve& after) {
  const runtime::CompiledCurve was(before), is(after);
  const double end = was.last_knot();
  return was.force(end) > 0 ? 1 - is.force(end) / was.force(end) : 0;
}

Softening cost(const Library& before, const Library& after, double cap) {
  Softening result;
  result.cap = cap;
  std::vector<double> losses;
  for (std::size_t v = 0; v < before.responses.size(); ++v) {
    const NodeResponse& was = before.responses[v];
    const NodeResponse& is = after.responses[v];
    if (was.status == ResponseStatus::Hole) continue;
    losses.push_back(lost(was.normal, is.normal));
    losses.push_back(lost(was.lateral, is.lateral));
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

double certified_bound(double damping, double rate) {
  return 0.5 * damping * rate;
}

Softening soften(Library& library, const CertifySettings& settings, double bound) {
  certify(library, settings);
  if (certified_lipschitz_bound(library.certificate) <= bound) return {};
  CertifySettings held = settings;
  held.limit = bound;
  const auto within = [&](Library& candidate) {
    certify(candidate, held);
    return candidate.certificate.hold <= bound;
  };
  if (within(library)) return {};
  const double steepest = steepest_slope(library);
  double low = kLeastShare * steepest, high = steepest;
  Library best = capped(library, low);
  if (!within(best)) {
    throw Error(ErrorKind::Configuration, "library '" + library.name + "'",
                "no softening certifies it for " + std::to_string(bound) +
                    " N/m: a hundredth of its slopes can be held to " +
                    std::to_string(best.certificate.hold) + " N/m",
                "raise the rate, or take a device with more damping");
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double cap = 0.5 * (low + high);
    Library candidate = capped(library, cap);
    if (within(candidate)) {
      low = cap;
      best = std::move(candidate);
    } else {
      high = cap;
    }
  }
  const Softening result = cost(library, best, low);
  library = std::move(best);
  return result;
}

}  // namespace palpate::fitting
