// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <map>

#include "fem/campaign/campaign.hpp"
#include "fem/campaign/campaign_cache.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;

Body small_block() {
  return test::make_block(test::even(-0.015, 0.015, 4), test::even(-0.015, 0.015, 4),
                          test::even(-0.015, 0, 2));
}

CampaignSettings quick() {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.45}}};
  s.indentation.depth = 0.002;
  s.indentation.increments = 3;
  s.indentation.lateral_depths = {0.002};
  s.indentation.lateral_increments = 2;
  s.indentation.lateral_travel = 0.001;
  return s;
}

void expect_same_bits(const SiteCurves& one, const SiteCurves& two) {
  EXPECT_EQ(one.vertex, two.vertex);
  ASSERT_EQ(one.paths.size(), two.paths.size());
  for (std::size_t p = 0; p < one.paths.size(); ++p) {
    ASSERT_EQ(one.paths[p].samples.size(), two.paths[p].samples.size());
    for (std::size_t s = 0; s < one.paths[p].samples.size(); ++s) {
      const auto &a = one.paths[p].samples[s], &b = two.paths[p].samples[s];
      EXPECT_EQ(std::memcmp(&a.force, &b.force, sizeof a.force), 0);
      EXPECT_EQ(a.strain_energy, b.strain_energy);
    }
  }
}

TEST(Campaign, GivesTheSameBitsWhateverTheNumberOfThreads) {
  const Body body = small_block();
  CampaignSettings settings = quick();
  CampaignReport report;
  const Curves one = run_campaign(body, settings, report);
  settings.threads = 2;
  const Curves two = run_campaign(body, settings, report);
  ASSERT_EQ(one.sites.size(), 9u);
  ASSERT_EQ(two.sites.size(), 9u);
  for (std::size_t i = 0; i < one.sites.size(); ++i) expect_same_bits(one.sites[i], two.sites[i]);
}

TEST(Campaign, ThatSharesAFactorHasTheSameBits) {
  const Body body = small_block();
  const CampaignSettings settings = quick();
  CampaignSettings some = settings, points = settings;
  const auto& is_site = body.response.is_site;
  const auto first = std::find(is_site.begin(), is_site.end(), std::uint8_t{1});
  some.sites = {static_cast<std::int32_t>(first - is_site.begin())};
  points.points = {{{0.002, 0.001, 0}, {0, 0, -1}}};
  points.indentation.lateral_depths.clear();
  CampaignReport report;
  CampaignCache cache;
  run_campaign(body, points, report, &cache);
  const Curves after = run_campaign(body, some, report, &cache);
  EXPECT_EQ(cache.factors.factorizations(), 1);
  ASSERT_EQ(after.sites.size(), 1u);
  expect_same_bits(after.sites[0], run_campaign(body, some, report).sites[0]);
}

TEST(Campaign, SymmetricSitesRespondAlike) {
  // Block and mesh (Kuhn cells) are symmetric under the exchange of x and y.
  const Body body = small_block();
  CampaignReport report;
  const Curves curves = run_campaign(body, quick(), report);
  const auto site_at = [&](double x, double y) -> const SiteCurves& {
    for (const auto& site : curves.sites) {
      const Vec3& p = body.nodes[to_index(body.response.node[to_index(site.vertex)])];
      if (std::abs(p[0] - x) + std::abs(p[1] - y) < 1e-9) return site;
    }
    throw std::logic_error("no such site");
  };
  const double a = norm(site_at(0.0075, -0.0075).paths[0].samples.back().force);
  const double b = norm(site_at(-0.0075, 0.0075).paths[0].samples.back().force);
  EXPECT_NEAR(a, b, 1e-3 * a);
}

std::ptrdiff_t threads_of_this_process() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
}

TEST(Campaign, StartsNoThreadsInLibraries) {
  // CHOLMOD and OpenBLAS would each bring threads to every site and the cores would thrash.
  const Body body = small_block();
  CampaignSettings settings = quick();
  const std::ptrdiff_t before = threads_of_this_process();
  std::ptrdiff_t most = 0;
  settings.progress = [&](const CampaignProgress&) {
    most = std::max(most, threads_of_this_process());
  };
  CampaignReport report;
  const Curves curves = run_campaign(body, settings, report);
  const auto site_threads = static_cast<std::ptrdiff_t>(curves.sites.size());
  EXPECT_LE(most, before + site_threads);
}

TEST(Campaign, ReportsItsProgress) {
  CampaignSettings settings = quick();
  settings.sites = {6, 8, 7};
  const Body body = small_block();
  std::vector<std::int32_t> sites;
  for (std::int32_t v = 0; v < 25; ++v)
    if (body.response.is_site[to_index(v)]) sites.push_back(v);
  settings.sites = {sites[2], sites[0]};
  std::vector<std::int64_t> seen;
  settings.progress = [&](const CampaignProgress& p) { seen.push_back(p.done * 100 + p.total); };
  CampaignReport report;
  const Curves curves = run_campaign(body, settings, report);
  EXPECT_THAT(seen, testing::ElementsAre(2, 102, 202));
  EXPECT_EQ(curves.sites[0].vertex, sites[0]);  // ascending
  EXPECT_GT(report.unknowns, 0);
}

TEST(Campaign, TellsTheIncrementsOfTheSitesThatRun) {
  const Body body = small_block();
  CampaignSettings settings = quick();
  std::map<std::int32_t, std::vector<double>> told;
  settings.advanced = [&](const CampaignProgress& p) {
    EXPECT_EQ(p.sites.size(), static_cast<std::size_t>(p.running));
    for (const SiteProgress& site : p.sites) {
      auto& fractions = told[site.vertex];
      if (fractions.empty() || fractions.back() != site.fraction)
        fractions.push_back(site.fraction);
    }
  };
  CampaignReport report;
  const Curves curves = run_campaign(body, settings, report);
  ASSERT_EQ(told.size(), curves.sites.size());
  for (const SiteCurves& site : curves.sites) {
    const auto& fractions = told[site.vertex];
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(fractions.front(), 0);
    EXPECT_EQ(fractions.back(), 1);
    std::size_t samples = 0;  // an increment each, but the start of a path
    for (const CurvePath& path : site.paths) samples += path.samples.size() - 1;
    EXPECT_EQ(fractions.size(), samples + 1);
  }
}

std::string refusal(const CampaignSettings& settings) {
  CampaignReport report;
  try {
    run_campaign(small_block(), settings, report);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "accepted";
}

TEST(Campaign, RefusesInvalidSettings) {
  CampaignSettings s = quick();
  s.materials[0].region = "bone";
  EXPECT_THAT(refusal(s), HasSubstr("use one of: tissue"));
  s = quick();
  s.materials.clear();
  EXPECT_THAT(refusal(s), HasSubstr("region 'tissue'"));
  s = quick();
  s.indentation.lateral_depths = {0.003};
  EXPECT_THAT(refusal(s), HasSubstr("exceeds the depth"));
  s = quick();
  s.indentation.tool.radius = std::nan("");
  EXPECT_THAT(refusal(s), HasSubstr("tool_radius"));
  s = quick();
  s.sites = {100000};
  EXPECT_THAT(refusal(s), HasSubstr("not a site"));
  s = quick();
  s.indentation.tool = {ToolShape::Disc, 0.005, 0, 0};
  EXPECT_THAT(refusal(s), HasSubstr("a sharp edge cannot be pressed without friction"));
  s = quick();
  s.materials[0].law.at("poisson") = 0.5;
  EXPECT_THAT(refusal(s), HasSubstr("poisson"));
}

TEST(Campaign, OfANoSlipDiscDoesNotDependOnRounding) {
  // A flat end on a flat surface: whether that lies a femtometre before or behind it at rest must
  // not decide what is beneath the end.
  CampaignSettings s = quick();
  s.indentation.tool = {ToolShape::Disc, 0.003, 0, 0};
  s.indentation.friction = ToolFriction::NoSlip;
  s.points = {{{0.001, 0.002, 0}, {0, 0, -1}}};
  const auto force = [&](double top) {
    const Body body = test::make_block(test::even(-0.015, 0.015, 4), test::even(-0.015, 0.015, 4),
                                       test::even(-0.015, top, 2));
    CampaignReport report;
    const Curves curves = run_campaign(body, s, report);
    return norm(curves.sites.at(0).paths.at(0).samples.back().force);
  };
  const double exact = force(0);
  for (const double top : {1e-15, -1e-15, 1e-12, -1e-12})
    EXPECT_NEAR(force(top), exact, 1e-6 * exact) << "top at " << top;
}

TEST(Campaign, HasThePartialCurveAndReasonOfAFailedSite) {
  CampaignSettings s = quick();
  s.indentation.depth = 0.03;  // the block is 15 mm thick
  s.indentation.lateral_depths.clear();
  const Body body = small_block();
  for (std::int32_t v = 0; v < 25 && s.sites.empty(); ++v)
    if (body.response.is_site[to_index(v)]) s.sites = {v};
  CampaignReport report;
  const Curves curves = run_campaign(body, s, report);
  EXPECT_NE(curves.sites[0].status, SiteStatus::Complete);
  EXPECT_THAT(curves.sites[0].reason, HasSubstr("normal path at "));
  EXPECT_GE(curves.sites[0].paths.at(0).samples.size(), 1u);
}

TEST(Campaign, HasTheReasonOfEveryFailedPath) {
  // Moved both ways into the fixed rim.
  CampaignSettings s = quick();
  s.indentation.lateral_travel = 0.03;
  s.indentation.lateral_increments = 1;
  s.indentation.azimuths = {3.0, 3.3};
  const Body body = small_block();
  for (std::int32_t v = 0; v < 25 && s.sites.empty(); ++v)
    if (body.response.is_site[to_index(v)]) s.sites = {v};
  CampaignReport report;
  const SiteCurves site = run_campaign(body, s, report).sites.at(0);
  EXPECT_EQ(site.status, SiteStatus::Partial);
  const std::string each = "lateral path at depth 2\\.00 mm at [0-9.]+ mm: [^;]+";
  EXPECT_THAT(site.reason, testing::MatchesRegex(each + "; " + each));
}

}  // namespace
}  // namespace palpate::fem
