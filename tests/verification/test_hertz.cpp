// SPDX-License-Identifier: AGPL-3.0-or-later
// A sphere pressed lightly into a large block, compared with the half-space of Hertz:
//   F = 4/3 E/(1 - nu^2) sqrt(R) d^(3/2),   contact radius a = sqrt(R d).
// R = 10 mm and d = 0.1 mm give a = 1 mm: large strains change the force by about 0.15 d/R = 0.15 %
// [Zhang et al. 2014], the base of the block, 100 a away, by about 1.13 a/h = 1.1 % at nu = 1/2.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "fem/campaign/indentation.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/verification/record.hpp"

namespace palpate::fem {
namespace {

constexpr double kYoung = 10e3, kRadius = 0.010;

struct Press {
  std::vector<CurveSample> samples;

  double force(std::size_t increment) const { return -samples[increment].force[2]; }
  double force() const { return force(samples.size() - 1); }
  double contact_radius() const { return std::sqrt(samples.back().contact_area / M_PI); }
};

struct Grid {
  double half, core, fine, growth;
};

Press press(const Grid& grid, double poisson, double depth, int increments) {
  const Body body = test::graded_block(grid.half, grid.core, grid.fine, grid.growth);
  std::int32_t centre = 0;
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& x = body.nodes[to_index(body.response.node[v])];
    if (x[0] == 0 && x[1] == 0) centre = static_cast<std::int32_t>(v);
  }
  CampaignSettings settings;
  settings.materials = {{"tissue", {kYoung, poisson}}};
  settings.indentation.tool.radius = kRadius;
  settings.indentation.depth = depth;
  settings.indentation.increments = increments;
  settings.indentation.lateral_depths.clear();
  settings.indentation.lateral_travel = 0;
  const CampaignContext context(body, settings, Engine::SharedFactor);
  const SiteCurves curves = solve_site(context, centre, nullptr);
  EXPECT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
  return {curves.paths.front().samples};
}

double hertz(double poisson, double depth) {
  return 4.0 / 3.0 * kYoung / (1 - poisson * poisson) * std::sqrt(kRadius) * std::pow(depth, 1.5);
}

class Hertz : public testing::TestWithParam<double> {};

TEST_P(Hertz, ForceConvergesToTheHalfSpace) {
  const double nu = GetParam(), depth = 1e-4, exact = hertz(nu, depth);
  const Press coarse = press({0.1, 0.0012, 1.2e-3, 3}, nu, depth, 2);
  const Press fine = press({0.1, 0.0012, 0.6e-3, 3}, nu, depth, 2);
  const auto row = [&](const char* what, const Press& press, double bound) {
    char name[96];
    std::snprintf(name, sizeof name, "force at nu = %.2f, %s", nu, what);
    test::verify({"Hertz: a sphere on a half-space, d/R = 0.01, base 100 contact radii away", name,
                  "mN", 1e3 * press.force(), 1e3 * exact, test::Reference::ClosedForm, "Hertz 1882",
                  bound});
  };
  row("0.8 elements per contact radius", coarse, 0.04);
  row("1.7 elements per contact radius", fine, 0.01);
  EXPECT_LT(std::abs(fine.force() / exact - 1), std::abs(coarse.force() / exact - 1));
  // A contact area counted in quadrature points has an error of about a third of an element.
  EXPECT_NEAR(fine.contact_radius(), std::sqrt(kRadius * depth), 0.2e-3);
}

INSTANTIATE_TEST_SUITE_P(Compressibility, Hertz, testing::Values(0.3, 0.49));

/// F = E*/2 ((a^2 + R^2) ln((R + a)/(R - a)) - 2 a R), d = a/2 ln((R + a)/(R - a)) [Sneddon 1965]:
/// a sphere instead of Hertz's paraboloid, small strains.
double sneddon(double poisson, double depth) {
  const double R = kRadius;
  const auto log_of = [&](double a) { return std::log((R + a) / (R - a)); };
  double low = 0, high = R;
  for (int i = 0; i < 100; ++i) {
    const double a = 0.5 * (low + high);
    (0.5 * a * log_of(a) < depth ? low : high) = a;
  }
  const double plane = kYoung / (1 - poisson * poisson);
  return 0.5 * plane * ((low * low + R * R) * log_of(low) - 2 * low * R);
}

/// At d/R = 0.2 strains are small enough for Sneddon's sphere. At d/R = 0.4 they are large:
/// F = 16/9 E0 sqrt(R) d^1.5 (1 - 0.15 d/R) for an incompressible neo-Hookean solid [Zhang et al.
/// 2014], recalled from the literature.
TEST(LargeStrain, DeepSphereOnNeoHookeanFollowsSneddonAndTheTrendOfZhang) {
  const double nu = 0.499, ratio = 0.4, depth = ratio * kRadius;
  const Press deep = press({0.6, 0.0075, 2.5e-3, 3}, nu, depth, 4);
  test::verify({"Large strain: a sphere on a neo-Hookean half-space",
                "force over Hertz at d/R = 0.4, nu = 0.499, 2.4 elements per contact radius", "1",
                deep.force() / hertz(nu, depth), 1 - 0.15 * ratio, test::Reference::Recalled,
                "Zhang et al. 2014: 1 - 0.15 d/R", 0.05});
  const double half = 0.5 * depth;
  test::verify({"Large strain: a sphere on a neo-Hookean half-space",
                "force over Hertz at d/R = 0.2, nu = 0.499, 1.7 elements per contact radius", "1",
                deep.force(2) / hertz(nu, half), sneddon(nu, half) / hertz(nu, half),
                test::Reference::ClosedForm, "Sneddon 1965, small strains", 0.03});
  EXPECT_NEAR(deep.force(4) / sneddon(nu, depth), 1, 0.04);
}

}  // namespace
}  // namespace palpate::fem
