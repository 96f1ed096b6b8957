// SPDX-License-Identifier: AGPL-3.0-or-later
// A body of a million triangles under the search at a low rate.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/handles.hpp"
#include "runtime/lockstep_search.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

TEST(Multirate, AMillionTrianglesFeelAsInTheSingleThread) {
  // Edges of 0.28 mm, 100 Hz beside 1 kHz, sliding at up to 0.2 m/s: seven triangles between looks.
  const palpate_library body(plate(708, 0.2, [](const Vec3& x) {
    return wall_response(170 * (1 + 0.4 * std::sin(90 * x[0])), 120);
  }));
  ASSERT_GT(body.surface.element_count(), 1000000);
  runtime::ContactState alone(body.surface, body.tree, {0.2, 5e-3});
  runtime::ContactState together(body.surface, body.tree, {0.2, 5e-3});
  runtime::LockstepSearch search(body.surface, body.tree, 10);
  std::uint32_t seen = 0;
  int slides = 0;
  for (int i = 0; i < 6000; ++i) {
    const double t = 1e-3 * i;
    const Vec3 x{0.1 + 0.08 * std::sin(2.2 * t), 0.1 + 0.03 * std::sin(3.1 * t),
                 0.0025 * std::cos(1.5 * t) - 0.001};
    seen |= alone.step(x);
    search.step(together, x);
    ASSERT_EQ(together.observation().force, alone.observation().force) << "step " << i;
    slides += together.observation().status & PALPATE_SLIDING ? 1 : 0;
  }
  EXPECT_TRUE(seen & PALPATE_RELEASED);
  EXPECT_GT(slides, 2500);
}

}  // namespace
}  // namespace palpate::test
