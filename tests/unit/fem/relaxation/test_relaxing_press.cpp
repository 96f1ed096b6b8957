// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/relaxation/relaxing_press.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fem/campaign/indentation.hpp"
#include "format/error.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kDepth = 1.5e-3, kPoisson = 0.499;
const RelaxationSeries kSeries{{0.3, 0.1}, {0.2, 1}};

Body block() {
  return test::make_block(test::even(-0.01, 0.01, 6), test::even(-0.01, 0.01, 6),
                          test::even(-0.01, 0, 4));
}

CampaignSettings settings_of(RelaxationSeries series, double poisson = kPoisson) {
  CampaignSettings settings;
  settings.materials = {{"tissue", {10e3, poisson}, 0, std::move(series)}};
  settings.indentation.tool.radius = 0.005;
  settings.indentation.depth = kDepth;
  settings.indentation.increments = 3;
  settings.indentation.force_tolerance = 1e-6;
  settings.indentation.lateral_depths.clear();
  return settings;
}

double force(const RelaxingSample& sample) {
  return -sample.force[2];
}

/// The sample at the end of the motion.
RelaxingSample end_of(const Body& body, const CampaignSettings& settings,
                      const std::vector<ToolMotion>& motion) {
  const RelaxingPress press =
      press_relaxing(body, settings, test::site_nearest(body), motion, {1e-3, 500});
  EXPECT_TRUE(press.complete) << press.reason;
  return press.samples.back();
}

TEST(RelaxingPress, OfElasticTissueHasTheForceOfTheCampaign) {
  const Body body = block();
  const CampaignSettings settings = settings_of({}, 0.45);
  const CampaignContext context(body, settings, Engine::Direct);
  const SiteCurves curves = solve_site(context, test::site_nearest(body), nullptr);
  ASSERT_EQ(curves.status, SiteStatus::Complete);
  const double expected = -curves.paths.front().samples.back().force[2];
  EXPECT_NEAR(force(end_of(body, settings, {{0, 0}, {1, kDepth}})), expected, 1e-5 * expected);
  // A step of any duration, and back and forth again.
  EXPECT_NEAR(force(end_of(body, settings, {{0, 0}, {0, kDepth}, {1, 0}, {1, kDepth}})), expected,
              1e-5 * expected);
}

TEST(RelaxingPress, WithoutSlipBondsTheSurfaceAsTheCampaign) {
  const Body body = block();
  CampaignSettings settings = settings_of({}, 0.45);
  settings.indentation.friction = ToolFriction::NoSlip;
  const CampaignContext context(body, settings, Engine::Direct);
  const SiteCurves curves = solve_site(context, test::site_nearest(body), nullptr);
  ASSERT_EQ(curves.status, SiteStatus::Complete);
  const double expected = -curves.paths.front().samples.back().force[2];
  EXPECT_NEAR(force(end_of(body, settings, {{0, 0}, {0, kDepth}})), expected, 1e-4 * expected);
}

/// As a record is sampled: the first piece ends just after the touch, where two steps bond the
/// surface otherwise than one by the same part of the force, however small they are.
TEST(RelaxingPress, WithoutSlipFollowsADenselySampledRamp) {
  const Body body = block();
  CampaignSettings settings = settings_of({}, 0.3);
  settings.indentation.friction = ToolFriction::NoSlip;
  settings.indentation.increments = 12;
  const CampaignContext context(body, settings, Engine::Direct);
  const SiteCurves curves = solve_site(context, test::site_nearest(body), nullptr);
  ASSERT_EQ(curves.status, SiteStatus::Complete);
  const double expected = -curves.paths.front().samples.back().force[2];
  std::vector<ToolMotion> motion;
  for (int i = 0; i <= 40; ++i) motion.push_back({0.01 * i, kDepth * i / 40});
  EXPECT_NEAR(force(end_of(body, settings, motion)), expected, 5e-3 * expected);
}

TEST(RelaxingPress, DragsTheBondedSurfaceAsTheCampaign) {
  const Body body = block();
  CampaignSettings settings = settings_of({}, 0.45);
  settings.indentation.lateral_depths = {kDepth};
  settings.indentation.azimuths = {0};
  settings.indentation.lateral_travel = 0.5e-3;
  settings.indentation.lateral_increments = 2;
  const CampaignContext context(body, settings, Engine::Direct);
  const SiteCurves curves = solve_site(context, test::site_nearest(body), nullptr);
  ASSERT_EQ(curves.status, SiteStatus::Complete);
  const auto& dragged = curves.paths.back();
  ASSERT_EQ(dragged.kind, PathKind::Lateral);
  const RelaxingSample end =
      end_of(body, settings, {{0, 0}, {1, kDepth}, {2, kDepth, 0.25e-3}, {2, kDepth, 0.5e-3}});
  EXPECT_EQ(end.drag, 0.5e-3);
  const Vec3 error = end.force - dragged.samples.back().force;
  EXPECT_LT(norm(error), 1e-4 * norm(end.force));
  EXPECT_GT(dot(end.force, dragged.direction), 0.1 * norm(end.force));
}

/// Work of the tool that presses and returns to where it was, by the trapezoidal rule.
double work_of_return(const RelaxationSeries& series) {
  const Body body = block();
  const RelaxingPress press = press_relaxing(body, settings_of(series), test::site_nearest(body),
                                             {{0, 0}, {0.1, kDepth}, {0.2, 0}}, {1e-3, 500});
  EXPECT_TRUE(press.complete) << press.reason;
  double work = 0;
  for (std::size_t i = 1; i < press.samples.size(); ++i) {
    const RelaxingSample &before = press.samples[i - 1], &after = press.samples[i];
    work += 0.5 * (force(before) + force(after)) * (after.travel - before.travel);
  }
  return work;
}

TEST(RelaxingPress, AReturnDissipatesWhereTheTissueRelaxes) {
  const double stored = 0.4 * kDepth * 0.1;  // of a force of about 0.1 N
  EXPECT_NEAR(work_of_return({}), 0, 2e-3 * stored);
  EXPECT_GT(work_of_return({{0.5, 0.1}}), 2e-2 * stored);
}

/// A nearly incompressible body with one series everywhere.
TEST(RelaxingPress, AHeldStepRelaxesAsTheSeries) {
  const Body body = block();
  const RelaxingPress press = press_relaxing(body, settings_of(kSeries), test::site_nearest(body),
                                             {{0, 0}, {0, kDepth}, {5, kDepth}}, {1e-3, 500});
  ASSERT_TRUE(press.complete) << press.reason;
  double at_once = 0;
  int held = 0;
  for (const RelaxingSample& sample : press.samples) {
    if (sample.travel < kDepth) continue;
    if (sample.time_s == 0) at_once = force(sample);
    const double g = relaxed_fraction(kSeries, sample.time_s);
    EXPECT_NEAR(force(sample), g * at_once, 0.003 * at_once) << sample.time_s;
    ++held;
  }
  EXPECT_GT(held, 10);
}

/// A tool that leaves faster than the tissue follows loses it, and meets it again where it then is.
TEST(RelaxingPress, TheSkinLagsBehindAToolThatLeaves) {
  const Body body = block();
  const CampaignSettings settings = settings_of({{0.9, 1}});
  const double lag = 0.4 * kDepth;
  const RelaxingPress press = press_relaxing(
      body, settings, test::site_nearest(body),
      {{0, 0}, {0.05, kDepth}, {3, kDepth}, {3, lag}, {3.02, lag}, {40, lag}}, {1e-3, 500});
  ASSERT_TRUE(press.complete) << press.reason;
  double after_release = -1;
  for (const RelaxingSample& sample : press.samples)
    if (sample.time_s <= 3.02 && sample.travel == lag) after_release = force(sample);
  EXPECT_EQ(after_release, 0);
  const double elastic = force(end_of(body, settings_of({}), {{0, 0}, {0, lag}}));
  EXPECT_NEAR(force(press.samples.back()), 0.1 * elastic, 0.02 * elastic);
}

TEST(RelaxingPress, RefusesAMotionThatIsNone) {
  const Body body = block();
  const auto message = [&](const std::vector<ToolMotion>& motion, CampaignSettings settings) {
    try {
      press_relaxing(body, settings, test::site_nearest(body), motion);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      return std::string(error.what());
    }
    return std::string();
  };
  using ::testing::HasSubstr;
  const CampaignSettings settings = settings_of(kSeries);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message({{0, 0}}, settings), HasSubstr("fewer than two points"));
  EXPECT_THAT(message({{0, 1e-3}, {1, 0}}, settings), HasSubstr("without contact"));
  EXPECT_THAT(message({{0, 0, 1e-4}, {1, 1e-3}}, settings), HasSubstr("without contact"));
  EXPECT_THAT(message({{0, 0}, {1, nan}}, settings), HasSubstr("point 1 is not finite"));
  EXPECT_THAT(message({{0, 0}, {1, 0, nan}}, settings), HasSubstr("point 1 is not finite"));
  EXPECT_THAT(message({{0, 0}, {1, 0}, {0.5, 0}}, settings), HasSubstr("goes back in time"));
  CampaignSettings heavy = settings;
  heavy.gravity.acceleration = {0, 0, -9.81};
  EXPECT_THAT(message({{0, 0}, {1, 0}}, heavy), HasSubstr("under its weight"));
  CampaignSettings loose = settings;
  loose.indentation.force_tolerance = 1e-3;
  EXPECT_THAT(message({{0, 0}, {1, 0}}, loose), HasSubstr("not above that of their equilibria"));
}

}  // namespace
}  // namespace palpate::fem
