// SPDX-License-Identifier: AGPL-3.0-or-later
// The inline functions of the runtime, compiled twice from one source: as the runtime itself is,
// and as a library of the offline side that includes them.
#pragma once

#include <vector>

#include "runtime/surface.hpp"

namespace palpate::test {

/// A contact point and the tips at which its local model is evaluated.
struct Evaluated {
  runtime::SurfacePoint point;
  std::vector<Vec3> tips;
};

/// Every number that a step computes at each tip: deflections, forces, energies, weights.
std::vector<double> evaluated_by_the_runtime(const runtime::Surface& surface,
                                             const std::vector<Evaluated>& states);
std::vector<double> evaluated_offline(const runtime::Surface& surface,
                                      const std::vector<Evaluated>& states);

}  // namespace palpate::test
