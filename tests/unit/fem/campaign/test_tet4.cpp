// SPDX-License-Identifier: AGPL-3.0-or-later
// The four-node tetrahedron in a campaign: what it shares with the quadratic one, and how far its
// forces are from those. Derivatives, windows and the patch test are among those of every element;
// rates and the absence of locking are verification.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fem/campaign/bonded_patch.hpp"
#include "fem/campaign/campaign.hpp"
#include "fem/campaign/indentation.hpp"
#include "fem/solve/preload.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/patch_work.hpp"

namespace palpate::fem {
namespace {

constexpr Dilatation kTet4 = Dilatation::LinearNodal;

Body block(int cells = 8) {
  return test::make_block(test::even(-0.02, 0.02, cells), test::even(-0.02, 0.02, cells),
                          test::even(-0.02, 0, cells / 2));
}

CampaignSettings settings(Dilatation dilatation, double poisson) {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, poisson}}};
  s.dilatation = dilatation;
  s.indentation.tool.radius = 0.01;
  s.indentation.depth = 0.003;
  s.indentation.increments = 20;
  s.indentation.lateral_depths = {0.002};
  s.indentation.lateral_travel = 0.001;
  s.indentation.lateral_increments = 6;
  return s;
}

SiteCurves press(const Body& body, const CampaignSettings& settings,
                 Engine engine = Engine::SharedFactor) {
  SiteCurves site =
      solve_site(CampaignContext(body, settings, engine), test::site_nearest(body), nullptr);
  EXPECT_EQ(site.status, SiteStatus::Complete) << site.reason;
  return site;
}

void expect_balance(const SiteCurves& site) {
  for (const CurvePath& path : site.paths) {
    const CurveSample& end = path.samples.back();
    EXPECT_NEAR(end.tool_work, end.strain_energy + end.contact_energy, 5e-3 * end.tool_work);
  }
}

TEST(Tet4, HasTheUnknownsOfItsCornersAlone) {
  const SolidModel model(block(), {make_law({10e3, 0.45}, "t")}, kTet4);
  EXPECT_EQ(model.pattern().n, 3 * (9 * 9 * 4));
}

/// Presses and drags by both engines, on a support and on springs under gravity.
TEST(Tet4, BothEnginesFindTheSameBalancedForces) {
  Body sprung = block();
  sprung.fixed_nodes.clear();
  for (std::size_t f = 0; f < sprung.boundary.size(); ++f) {
    const Triangle& facet = sprung.boundary[f];
    const auto at_base = [&](std::int32_t node) {
      return sprung.nodes[to_index(node)][2] < -0.0199;
    };
    if (std::ranges::all_of(facet, at_base))
      sprung.foundation.push_back({static_cast<std::int32_t>(f), 1e6, 1e6});
  }
  CampaignSettings heavy = settings(kTet4, 0.49);
  heavy.gravity = {{0, 0, -9.81}, 1000};
  for (const auto& [body, s] : {std::pair{block(), settings(kTet4, 0.49)}, {sprung, heavy}}) {
    const SiteCurves shared = press(body, s), direct = press(body, s, Engine::Direct);
    ASSERT_EQ(shared.paths.size(), 2u);
    for (std::size_t p = 0; p < shared.paths.size(); ++p) {
      const Vec3 a = shared.paths[p].samples.back().force, b = direct.paths[p].samples.back().force;
      EXPECT_LT(norm(a - b), 1e-3 * norm(b));
    }
    expect_balance(shared);
  }
}

/// The weight of a linear element lies on its corners: what they carry is rho V g, and a column
/// that cannot bulge (nu = 0) shortens by rho g H^2/(2 E), exact at its nodes.
TEST(Tet4, AColumnShortensUnderItsWeight) {
  constexpr double kHeight = 0.08, kYoung = 1e7, kWeight = 9810;
  const Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, kHeight, 8));
  const SolidModel model(body, {make_law({kYoung, 0.0}, "t")}, kTet4, {{0, 0, -9.81}, 1000});
  const Displacement u =
      equilibrium_under_weight(model, nested_dissection(model.pattern()), body.name);
  const double expected = kWeight * kHeight * kHeight / (2 * kYoung);
  double sum = 0;
  int count = 0;
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (model.mesh().X(2, node) > kHeight - 1e-9) {
      sum -= u(2, node);
      ++count;
    }
  EXPECT_NEAR(sum / count, expected, 0.02 * expected);
}

TEST(Tet4, StoresTheWorkDoneOnABondedPatch) {
  const PatchCurve curve =
      press_patch(block(), settings(kTet4, 0.49), test::site_nearest(block()), 0.0051);
  test::expect_work_is_stored(curve);
}

/// Under a tool whose contact spans two elements the excess near nu = 1/2 is that far from it: Tet4
/// does not lock. With twice as many elements along an edge, and as many nodes, it is a third.
TEST(Tet4, IsStifferThanQuadraticElementsButNoMoreSoNearIncompressibility) {
  const auto force = [](Dilatation dilatation, double poisson, int cells) {
    CampaignSettings s = settings(dilatation, poisson);
    s.indentation.increments = 4;
    s.indentation.lateral_depths.clear();
    return norm(press(block(cells), s).paths.front().samples.back().force);
  };
  const auto excess = [&](double poisson, int cells) {
    return force(kTet4, poisson, cells) / force(Dilatation::Nodal, poisson, 8) - 1;
  };
  const double far = excess(0.3, 8), near = excess(0.49, 8), fine = excess(0.49, 16);
  EXPECT_GT(far, 0);
  EXPECT_LT(far, 0.5);
  EXPECT_NEAR(near, far, 0.1);
  EXPECT_LT(fine, 0.5 * near);
}

TEST(Tet4, IsNamedInTheReportOfACampaign) {
  CampaignSettings s = settings(kTet4, 0.45);
  s.indentation.increments = 1;
  s.indentation.lateral_depths.clear();
  s.sites = {test::site_nearest(block())};
  CampaignReport report;
  run_campaign(block(), s, report);
  EXPECT_THAT(report.facts, testing::Contains(testing::Pair(
                                "element", testing::HasSubstr("Tet4, nodal pressure"))));
  EXPECT_EQ(report.unknowns, 3 * (9 * 9 * 4));
}

}  // namespace
}  // namespace palpate::fem
