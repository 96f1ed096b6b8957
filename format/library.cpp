// SPDX-License-Identifier: Apache-2.0
#include "format/library.hpp"

#include <algorithm>
#include <cmath>

#include "format/numbers.hpp"

namespace palpate {

double CouplingCurve::largest() const {
  if (curve.slope.empty()) return static_cast<double>(base);
  if (curve.slope.back() > 0) return kInfinity;
  double w = static_cast<double>(base);
  for (std::size_t k = 1; k < curve.knot.size(); ++k)
    w += 0.5 * static_cast<double>(curve.knot[k] - curve.knot[k - 1]) *
         static_cast<double>(curve.slope[k - 1] + curve.slope[k]);
  return w;
}

bool Library::leans() const {
  return std::any_of(responses.begin(), responses.end(),
                     [](const NodeResponse& node) { return node.lean != std::array<float, 3>{}; });
}

bool Library::has_soft_axes() const {
  return std::any_of(responses.begin(), responses.end(), [](const NodeResponse& node) {
    return node.status != ResponseStatus::Hole && node.soft_axis != std::array<float, 3>{};
  });
}

double enforced_lipschitz_bound(const Certificate& certificate) {
  const Certificate& c = certificate;
  if (c.triangles.empty()) return std::numeric_limits<double>::infinity();
  if (!std::isnan(c.lipschitz_bound)) return c.lipschitz_bound;
  const double slides = std::min(std::max(c.stick, c.slip), 4 * c.stick);
  return std::isfinite(c.min_lipschitz_bound) ? std::max(slides, c.min_lipschitz_bound) : slides;
}

double certified_lipschitz_bound(const Certificate& certificate) {
  const double limit = enforced_lipschitz_bound(certificate);
  const bool free = limit >= std::max(certificate.stick, certificate.slip);
  return free || limit >= certificate.min_lipschitz_bound ? limit
                                                          : std::numeric_limits<double>::infinity();
}

}  // namespace palpate
