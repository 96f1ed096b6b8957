// SPDX-License-Identifier: AGPL-3.0-or-later
// A sphere pressed lightly into a large block, against the half-space of Hertz:
//   F = 4/3 E/(1 - nu^2) sqrt(R) d^(3/2),   contact radius a = sqrt(R d).
// R = 10 mm and d = 0.1 mm give a = 1 mm: large strains change the force by about 0.15 d/R = 0.15 %
// [Zhang et al. 2014], the base of the block, 100 a away, by about 1.13 a/h = 1.1 % at nu = 1/2.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fem/at.hpp"
#include "fem/indentation.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kYoung = 10e3, kRadius = 0.010, kDepth = 1e-4;

struct Press {
  double force;
  double contact_radius;
  int nodes;
};

Press press(double fine, double poisson) {
  const auto across = test::graded(0.1, 0.0012, fine, 3.0);
  std::vector<double> down;
  for (const double x : across)
    if (x <= 0) down.push_back(x);
  const Body body = test::make_block(across, across, down);
  std::int32_t centre = 0;
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& x = body.nodes[at(body.response.node[v])];
    if (x[0] == 0 && x[1] == 0) centre = static_cast<std::int32_t>(v);
  }
  CampaignSettings settings;
  settings.materials = {{"tissue", {kYoung, poisson}}};
  settings.indentation.tool.radius = kRadius;
  settings.indentation.depth = kDepth;
  settings.indentation.increments = 2;
  settings.indentation.held_depths.clear();
  settings.indentation.lateral_travel = 0;
  const CampaignContext context(body, settings, Engine::SharedFactor);
  const SiteCurves curves = solve_site(context, centre, nullptr);
  EXPECT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
  const CurveSample& end = curves.paths.front().samples.back();
  return {-end.force[2], std::sqrt(end.contact_area / M_PI), context.model.mesh().nodes()};
}

double hertz(double poisson) {
  return 4.0 / 3.0 * kYoung / (1 - poisson * poisson) * std::sqrt(kRadius) * std::pow(kDepth, 1.5);
}

class Hertz : public testing::TestWithParam<double> {};

TEST_P(Hertz, ForceConvergesToTheHalfSpace) {
  const double nu = GetParam(), exact = hertz(nu);
  const Press coarse = press(1.2e-3, nu), fine = press(0.6e-3, nu);
  const double coarse_error = coarse.force / exact - 1, fine_error = fine.force / exact - 1;
  std::printf(
      "nu %.2f: Hertz %.4f mN; %d nodes %+.2f %%, %d nodes %+.2f %%; contact radius %.3f mm\n", nu,
      1e3 * exact, coarse.nodes, 100 * coarse_error, fine.nodes, 100 * fine_error,
      1e3 * fine.contact_radius);
  EXPECT_LT(std::abs(fine_error), 0.02);
  EXPECT_LT(std::abs(fine_error), std::abs(coarse_error));
  // An area counted in quadrature points is known to about a third of an element.
  EXPECT_NEAR(fine.contact_radius, std::sqrt(kRadius * kDepth), 0.2e-3);
}

INSTANTIATE_TEST_SUITE_P(Compressibility, Hertz, testing::Values(0.3, 0.49));

}  // namespace
}  // namespace palpate::fem
