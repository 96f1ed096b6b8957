// SPDX-License-Identifier: Apache-2.0
#include "format/library.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {

bool Library::leans() const {
  return std::any_of(responses.begin(), responses.end(),
                     [](const NodeResponse& node) { return node.lean != std::array<float, 3>{}; });
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
