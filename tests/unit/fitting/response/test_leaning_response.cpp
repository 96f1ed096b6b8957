// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/leaning_response.hpp"

#include <gtest/gtest.h>

namespace palpate::fitting {
namespace {

TEST(LeaningResponse, DoesTheWorkOfItsNormalForce) {
  NodeResponse node;
  node.lateral = {{0, 0.001F, 0.004F}, {400, 700, 300}};
  node.coupling = {0.4F, {{0, 0.002F, 0.006F, 0.0075F}, {0, 200, 90, 0}}};
  node.lean = {0.12F, 0.05F, 0};
  const LeaningResponse lean(node, ResponseKind::Coupled);
  constexpr int kParts = 400;
  for (const double z : {0.0004, 0.0017, 0.003, 0.0059, 0.007}) {
    const double force = lean.normal_force(z);
    const double w = runtime::CompiledCurve(node.coupling.curve, 0.4).force(z);
    EXPECT_NEAR(force, w * 0.13 * norm(lean.transverse_force(z)), 1e-6 * force);
    double work = 0;  // by the midpoint rule
    for (int k = 0; k < kParts; ++k) work += z / kParts * lean.normal_force(z * (k + 0.5) / kParts);
    EXPECT_NEAR(lean.energy(z), work, 2e-3 * work);
  }
}

}  // namespace
}  // namespace palpate::fitting
