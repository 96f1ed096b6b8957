// SPDX-License-Identifier: AGPL-3.0-or-later
// A flat disc in no-slip contact with a half-space, pressed lightly and moved sideways, with nu
// near 1/2, where the two directions are uncoupled:
//   k_n = 4 G a/(1 - nu) [Boussinesq],   k_t = 8 G a/(2 - nu) [Mindlin 1949].
#include <gtest/gtest.h>

#include <cmath>

#include "fem/campaign/indentation.hpp"
#include "tests/verification/record.hpp"
#include "tests/verification/round_layer.hpp"

namespace palpate::fem {
namespace {

TEST(NoSlipDisc, IsAsStiffAlongAndAcrossAsInClosedForm) {
  constexpr double kYoung = 10e3, kPoisson = 0.49, kRadius = 0.005, kDepth = 1e-3 * kRadius;
  const double G = kYoung / (2 * (1 + kPoisson));
  const Body body = test::make_round_layer({kRadius, 5, 2, 150 * kRadius, 150 * kRadius});
  CampaignSettings s;
  s.materials = {{"tissue", {kYoung, kPoisson}}};
  s.indentation.tool = {ToolShape::Disc, kRadius, 0, 0};
  s.indentation.friction = ToolFriction::NoSlip;
  s.indentation.depth = kDepth;
  s.indentation.increments = 1;
  s.indentation.lateral_depths = {kDepth};
  s.indentation.lateral_travel = kDepth;
  s.indentation.lateral_increments = 1;
  s.indentation.azimuths = {0.3};
  s.indentation.force_tolerance = 3e-5;
  const CampaignContext context(body, s, Engine::SharedFactor);
  const SiteCurves curves = solve_site(context, 0, nullptr);
  ASSERT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
  const auto stiffness = [](const CurvePath& path) {
    const Vec3 change = path.samples.back().force - path.samples.front().force;
    return dot(change, path.direction) / path.samples.back().displacement;
  };
  const double normal = stiffness(curves.paths.front()), lateral = stiffness(curves.paths.back());
  const std::string problem = "Flat disc in no-slip contact with a half-space, nu = 0.49";
  test::verify({problem, "normal stiffness over 4 G a/(1 - nu)", "1",
                normal / (4 * G * kRadius / (1 - kPoisson)), 1, test::Reference::ClosedForm,
                "Boussinesq", 0.03});
  test::verify({problem, "lateral stiffness over 8 G a/(2 - nu)", "1",
                lateral / (8 * G * kRadius / (2 - kPoisson)), 1, test::Reference::ClosedForm,
                "Mindlin 1949", 0.03});
  const double ratio = 2 * (1 - kPoisson) / (2 - kPoisson);
  EXPECT_NEAR(lateral / normal, ratio, 0.02 * ratio);
}

}  // namespace
}  // namespace palpate::fem
