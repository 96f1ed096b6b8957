// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/path_driver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fem/campaign/indentation.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;

CampaignSettings pressing(const LawConstants& law) {
  CampaignSettings settings;
  settings.materials = {{"tissue", law}};
  settings.indentation.tool.radius = 0.008;
  settings.indentation.depth = 0.002;
  settings.indentation.increments = 20;
  settings.indentation.lateral_depths = {0.001};
  settings.indentation.lateral_travel = 0.001;
  settings.indentation.lateral_increments = 10;
  return settings;
}

SiteCurves press(const Body& body, const CampaignSettings& settings, Engine engine,
                 Displacement* pressed = nullptr) {
  return solve_site(CampaignContext(body, settings, engine), test::site_nearest(body), pressed);
}

/// A softening law of I1 alone loses ellipticity in simple shear of 0.35. The neo-Hookean solid of
/// the same modulus never does.
TEST(PathDriver, EndsThePathWhereStrongEllipticityIsLost) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.012, 0, 3));
  CampaignSettings settings =
      pressing({"yeoh", {{"C10", 1.5e3}, {"C20", -2.5e3}, {"C30", 1.6e3}, {"poisson", 0.45}}});
  settings.indentation.depth = 0.005;
  settings.indentation.lateral_depths.clear();
  const SiteCurves softening = press(body, settings, Engine::SharedFactor);
  EXPECT_EQ(softening.status, SiteStatus::Partial);
  EXPECT_THAT(softening.reason, HasSubstr("strong ellipticity is lost in the element at ("));
  EXPECT_THAT(softening.reason, HasSubstr("normal path at "));
  const auto& reached = softening.paths.front().samples;
  EXPECT_GT(reached.size(), 2u);
  EXPECT_LT(reached.back().displacement, 0.005);
  settings.materials[0].law = {2 * 1.45 * 3e3, 0.45};
  const SiteCurves sound = press(body, settings, Engine::SharedFactor);
  EXPECT_EQ(sound.status, SiteStatus::Complete) << sound.reason;
}

/// The depth at which a law that softens loses ellipticity does not hang on the increments.
TEST(PathDriver, ReachesTheOnsetOfAFaultInCoarseIncrementsToo) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.012, 0, 3));
  const auto press = [&](int increments) {
    CampaignSettings settings =
        pressing({"yeoh", {{"C10", 1.5e3}, {"C20", -2.5e3}, {"C30", 1.6e3}, {"poisson", 0.45}}});
    settings.indentation.depth = 0.005;
    settings.indentation.increments = increments;
    settings.indentation.lateral_depths = {0.0049};  // beyond the onset
    settings.indentation.lateral_travel = 2e-5;
    settings.indentation.lateral_increments = 2;
    return fem::press(body, settings, Engine::SharedFactor);
  };
  const SiteCurves coarse = press(1), fine = press(50);
  const CurveSample &end = coarse.paths.front().samples.back(),
                    &onset = fine.paths.front().samples.back();
  EXPECT_EQ(coarse.status, SiteStatus::Partial);
  EXPECT_LT(onset.displacement, 0.0045);
  EXPECT_GT(end.displacement, 0.001);
  // The largest step is a quarter of the radius; the fine path ends within its own increment.
  EXPECT_NEAR(end.displacement, onset.displacement, 0.002 / 32 + 0.005 / 50 / 32);
  const auto& samples = fine.paths.front().samples;
  const auto above = std::find_if(samples.begin(), samples.end(), [&](const CurveSample& sample) {
    return sample.displacement >= end.displacement;
  });
  ASSERT_NE(above, samples.end());
  const CurveSample& below = *(above - 1);
  const double t =
      (end.displacement - below.displacement) / (above->displacement - below.displacement);
  const double force = (1 - t) * norm(below.force) + t * norm(above->force);
  EXPECT_NEAR(norm(end.force), force, 1e-3 * force);
  // No lateral depth was reached: the lateral path is where the press ended.
  ASSERT_EQ(coarse.paths.size(), 2u);
  EXPECT_EQ(coarse.paths[1].kind, PathKind::Lateral);
  EXPECT_EQ(coarse.paths[1].lateral_depth, end.displacement);
  EXPECT_EQ(norm(coarse.paths[1].samples.front().force), norm(end.force));
}

/// A no-slip press finds where it met the surface with less accuracy, and then what it records: to
/// the last sample, also where the path ends within an increment.
TEST(PathDriver, EndsANoSlipPressWithASampleOfTheWantedAccuracy) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.012, 0, 3));
  const auto press = [&](double tolerance) {
    CampaignSettings settings =
        pressing({"yeoh", {{"C10", 1.5e3}, {"C20", -2.5e3}, {"C30", 1.6e3}, {"poisson", 0.45}}});
    settings.indentation.friction = ToolFriction::NoSlip;
    settings.indentation.depth = 0.005;
    settings.indentation.increments = 4;
    settings.indentation.lateral_depths.clear();
    settings.indentation.force_tolerance = tolerance;
    return fem::press(body, settings, Engine::SharedFactor);
  };
  const SiteCurves site = press(1e-3), exact = press(1e-7);
  EXPECT_EQ(site.status, SiteStatus::Partial);
  const auto &samples = site.paths.front().samples, &there = exact.paths.front().samples;
  ASSERT_EQ(samples.size(), there.size());
  ASSERT_GT(samples.size(), 2u);
  EXPECT_GT(std::fmod(samples.back().displacement, 0.00125), 1e-6);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    ASSERT_EQ(samples[i].displacement, there[i].displacement);
    EXPECT_NEAR(norm(samples[i].force), norm(there[i].force), 1e-3 * norm(there[i].force)) << i;
  }
}

/// The tool reaches over a fixed rim: from there on a rigid body answers.
TEST(PathDriver, EndsThePathWhereTheToolTouchesASupport) {
  Body body = test::make_block(test::even(-0.016, 0.016, 8), test::even(-0.016, 0.016, 8),
                               test::even(-0.012, 0, 3));
  const std::int32_t site = test::site_nearest(body);
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(body.nodes.size()); ++node)
    if (body.nodes[static_cast<std::size_t>(node)][0] > 0.003) body.fixed_nodes.push_back(node);
  CampaignSettings settings = pressing({10e3, 0.45});
  settings.indentation.tool = {ToolShape::Disc, 0.008, 0.001, 0};
  settings.indentation.lateral_depths.clear();
  const SiteCurves curves =
      solve_site(CampaignContext(body, settings, Engine::SharedFactor), site, nullptr);
  EXPECT_NE(curves.status, SiteStatus::Complete);
  EXPECT_THAT(curves.reason, HasSubstr("the tool touches a support at"));
}

constexpr double kRadius = 0.005;

/// The work in steps of a fifth of the radius against the trapezoidal rule over steps of a
/// hundredth.
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
