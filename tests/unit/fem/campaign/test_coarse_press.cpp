// SPDX-License-Identifier: AGPL-3.0-or-later
// The work that a press in large increments says it did.
#include <gtest/gtest.h>

#include "fem/campaign/indentation.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kRadius = 0.005;

/// A press in steps of a fifth of the radius against one in steps of a hundredth, whose forces are
/// integrated here, by the engine that factorizes the whole body and by the one that does not.
class CoarsePress : public testing::TestWithParam<Engine> {};

TEST_P(CoarsePress, DoesTheWorkOfAFineOneAtEverySample) {
  const auto across = test::even(-0.02, 0.02, 10);
  const Body body = test::make_block(across, across, {-0.02, -0.012, -0.006, -0.003, 0});
  const auto press = [&](int increments, Engine engine) {
    CampaignSettings settings;
    settings.materials = {{"tissue", {10e3, 0.45}}};
    settings.indentation.tool.radius = kRadius;
    settings.indentation.depth = 0.003;
    settings.indentation.increments = increments;
    settings.indentation.lateral_depths.clear();
    settings.points = {{{0.0013, 0.0007, 0}, {0, 0, -1}}};
    const CampaignContext context(body, settings, engine);
    return solve_site(context, 0, nullptr).paths.front().samples;
  };
  const auto coarse = press(3, GetParam()), fine = press(60, Engine::SharedFactor);
  double work = 0;
  for (std::size_t i = 1; i < fine.size(); ++i) {
    work -= 0.5 * (fine[i].force[2] + fine[i - 1].force[2]) *
            (fine[i].displacement - fine[i - 1].displacement);
    if (i % 20 == 0) {
      EXPECT_NEAR(coarse[i / 20].tool_work, work, (i == 20 ? 0.02 : 0.005) * work) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, CoarsePress,
                         testing::Values(Engine::SharedFactor, Engine::Direct),
                         [](const auto& instance) {
                           return instance.param == Engine::Direct ? "Direct" : "SharedFactor";
                         });

}  // namespace
}  // namespace palpate::fem
