// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/sampling/site_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/response/fit.hpp"
#include "tests/unit/fitting/plate_body.hpp"

namespace palpate::fitting {
namespace {

TEST(SiteChoice, FirstSitesAreSpreadOverTheSurface) {
  const Body body = plate(12);
  const double spacing = 0.018;
  const auto sites = spread_sites(body, spacing);
  for (const std::int32_t a : sites)
    for (const std::int32_t b : sites)
      EXPECT_TRUE(a == b || norm(position(body, a) - position(body, b)) >= spacing);
  for (const Vec3& x : body.nodes) {
    double nearest = 1;
    for (const std::int32_t a : sites) nearest = std::min(nearest, norm(x - position(body, a)));
    EXPECT_LT(nearest, spacing);
  }
}

TEST(SiteChoice, NewSitesAreWhereTheStiffnessVaries) {
  const Body body = plate(20);
  const Vec3 centre{0.07, 0.03, 0};
  const Field nodule = [&](const Vec3& x) {
    const Vec3 r = x - centre;
    return 1 + 3 * std::exp(-dot(r, r) / (2 * 0.008 * 0.008));
  };
  auto sites = spread_sites(body, 0.02);
  const Curves before = press_all(body, sites, nodule);
  const Library coarse = fit(body, before, interpolating());
  const auto added = next_sites(body, sites, coarse, 0.05, 12);
  ASSERT_EQ(added.size(), 12U);
  for (const std::int32_t v : added) {
    EXPECT_LT(norm(position(body, v) - centre), 0.045) << "far from the nodule";
    EXPECT_FALSE(std::binary_search(sites.begin(), sites.end(), v));
  }
  const auto worst = [&](const Library& library) {
    double largest = 0;
    for (std::size_t v = 0; v < body.nodes.size(); ++v) {
      const double direct = law(nodule(body.nodes[v]));
      largest = std::max(largest, std::abs(deepest_force(library, v) - direct) / direct);
    }
    return largest;
  };
  sites.insert(sites.end(), added.begin(), added.end());
  std::sort(sites.begin(), sites.end());
  const Library fine = fit(body, press_all(body, sites, nodule), interpolating());
  EXPECT_LT(worst(fine), 0.5 * worst(coarse));
}

TEST(SiteChoice, AFailedSiteRemainsAHoleAndIsNotChosenAgain) {
  const Body body = plate(12);
  const Field even = [](const Vec3&) { return 1.0; };
  const auto sites = spread_sites(body, 0.012);
  Curves curves = press_all(body, sites, even);
  SiteCurves& failed = curves.sites[sites.size() / 2];
  failed.status = SiteStatus::Failed;
  failed.reason = "inverted element";
  failed.paths.clear();
  const Library library = fit(body, curves, interpolating());
  const auto hole = static_cast<std::size_t>(failed.vertex);
  EXPECT_EQ(library.responses[hole].status, ResponseStatus::Hole);
  const auto added = next_sites(body, sites, library, 1e-6, 1000);
  EXPECT_EQ(std::count(added.begin(), added.end(), failed.vertex), 0);
}

}  // namespace
}  // namespace palpate::fitting
