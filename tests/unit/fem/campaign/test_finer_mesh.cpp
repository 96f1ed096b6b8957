// SPDX-License-Identifier: AGPL-3.0-or-later
// Sites that are pressed on a finer mesh as well, and what they tell of the others.
#include "fem/campaign/finer_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fitting/response/mesh_error.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// A block whose elements are half as large on one side as on the other.
Body uneven_block() {
  Body body = test::make_block(test::even(-0.02, 0.02, 8), test::even(-0.02, 0.02, 8),
                               test::even(-0.02, 0, 4));
  test::deform(body, [](const Vec3& x) {
    const auto stretched = [](double c) { return c + 0.3 * (c * c / 0.02 - 0.02); };
    return Vec3{stretched(x[0]), stretched(x[1]), x[2]};
  });
  return body;
}

std::vector<std::int32_t> sites_of(const Body& body) {
  std::vector<std::int32_t> sites;
  for (std::size_t v = 0; v < body.response.is_site.size(); ++v)
    if (body.response.is_site[v] != 0) sites.push_back(static_cast<std::int32_t>(v));
  return sites;
}

CampaignSettings pressed() {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.45}}};
  s.indentation.tool.radius = 0.005;
  s.indentation.depth = 0.001;
  s.indentation.increments = 7;
  s.indentation.lateral_depths.clear();
  s.threads = 2;
  return s;
}

TEST(FinerMesh, ChoosesSitesFarApart) {
  const Body body = uneven_block();
  const auto chosen = sites_far_apart(body, sites_of(body), 4);
  ASSERT_EQ(chosen.size(), 4u);
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b)
      EXPECT_GT(norm(body.nodes[to_index(body.response.node[to_index(chosen[a])])] -
                     body.nodes[to_index(body.response.node[to_index(chosen[b])])]),
                0.02);
  EXPECT_EQ(sites_far_apart(body, {3, 5}, 4), (std::vector<std::int32_t>{3, 5}));
}

/// On top of a block 9 x 9 sites, the outer ones 4 mm from the edges, where the contact of a deep
/// press reaches.
TEST(FinerMesh, ChoosesSitesAtSharpEdgesAndElsewhere) {
  const Body body = test::make_block(test::even(-0.02, 0.02, 10), test::even(-0.02, 0.02, 10),
                                     test::even(0, 0.02, 4));
  const std::vector<std::int32_t> sites = sites_of(body);
  ASSERT_EQ(sites.size(), 81U);
  const ToolDescription sphere{"sphere", 0.01, "frictionless", 0, 0};
  const auto near = at_sharp_edges(body, sphere, 0.001),
             shallow = at_sharp_edges(body, sphere, 5e-4);
  for (const std::int32_t v : sites) {
    const Vec3& x = body.nodes[to_index(body.response.node[to_index(v)])];
    EXPECT_EQ(near[to_index(v)], std::max(std::abs(x[0]), std::abs(x[1])) > 0.0155);
    EXPECT_FALSE(shallow[to_index(v)]);
  }
  CampaignSettings settings = pressed();
  settings.indentation.tool.radius = sphere.radius;
  EXPECT_TRUE(sites_on_finer_mesh(body, settings, sites).empty());
  settings.mesh_error_sites = 4;
  const auto chosen = sites_on_finer_mesh(body, settings, sites);
  EXPECT_EQ(chosen.size(), 7U);  // four of the 49 inside, every tenth of the 32 at the edges
  EXPECT_EQ(std::count_if(chosen.begin(), chosen.end(),
                          [&](std::int32_t v) { return near[to_index(v)]; }),
            3);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_EQ(sites_on_finer_mesh(body, settings, {sites.front()}), std::vector{sites.front()});
  settings.dilatation = Dilatation::LinearNodal;
  EXPECT_TRUE(sites_on_finer_mesh(body, settings, sites).empty());
}

/// Three sites bound the error of others, which is known from elements that are small beside the
/// contact. The facets are 3 to 8 mm large, the contacts 0.8 to 2.2 mm: errors of tens of percent.
TEST(FinerMesh, OfAFewSitesBoundsTheErrorOfOthers) {
  const Body body = uneven_block();
  CampaignSettings settings = pressed();
  CampaignReport report;
  const auto chosen = sites_far_apart(body, sites_of(body), 3);
  std::vector<std::int32_t> others;
  for (const auto& [x, y] : {std::pair{-0.006, -0.004}, {0.001, 0.004}, {0.008, -0.003}})
    others.push_back(test::site_nearest(body, x, y));
  settings.sites = chosen;
  settings.sites.insert(settings.sites.end(), others.begin(), others.end());
  Curves curves = run_campaign(body, settings, report);
  press_on_finer_mesh(body, settings, chosen, curves, report);
  fitting::bound_mesh_errors(curves);
  EXPECT_DOUBLE_EQ(curves.mesh_error_confidence, 0.95);

  settings.sites = others;
  settings.indentation.refine_under_tool = IndentationSettings::kByContact;
  int covered = 0, compared = 0;
  double largest = 0;
  for (const SiteCurves& truth : run_campaign(body, settings, report).sites) {
    const auto site = std::find_if(curves.sites.begin(), curves.sites.end(),
                                   [&](const auto& s) { return s.vertex == truth.vertex; });
    for (std::size_t i = 1; i < truth.paths[0].samples.size(); ++i) {
      const CurveSample& ours = site->paths[0].samples[i];
      const double error = std::abs(ours.force[2] - truth.paths[0].samples[i].force[2]);
      largest = std::max(largest, error / norm(ours.force));
      covered += error <= ours.mesh_error ? 1 : 0;
      ++compared;
    }
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_GE(covered, 0.9 * compared) << covered << " of " << compared;
}

/// What is left where the contact divides the elements already: less than where it does not, and
/// bounded by a few sites as well, against elements of half the size. They are twice as large as
/// usual, because smaller ones take minutes; `bench_mesh_error bound` has the usual ones.
TEST(FinerMesh, OfAFewSitesBoundsTheErrorOfElementsThatTheContactDivides) {
  const Body body = uneven_block();
  CampaignSettings settings = pressed();
  settings.indentation.refine_under_tool = IndentationSettings::kByContact;
  const double usual = settings.indentation.size_over_contact;
  settings.indentation.size_over_contact = 2 * usual;
  settings.indentation.increments = 4;
  CampaignReport report;
  for (const auto& [x, y] : {std::pair{-0.009, -0.008}, {0.009, -0.009}, {0.001, 0.009}})
    settings.sites.push_back(test::site_nearest(body, x, y));
  const auto chosen = settings.sites;
  for (const auto& [x, y] : {std::pair{-0.006, -0.004}, {0.001, 0.004}, {0.008, -0.003}})
    settings.sites.push_back(test::site_nearest(body, x, y));
  Curves curves = run_campaign(body, settings, report);
  press_on_finer_mesh(body, settings, chosen, curves, report);
  fitting::bound_mesh_errors(curves);
  EXPECT_GT(curves.mesh_error_confidence, 0.8);

  settings.indentation.size_over_contact = usual;
  int covered = 0, compared = 0;
  double largest = 0, bounds = 0;
  const Curves truth = run_campaign(body, settings, report);
  for (std::size_t s = 0; s < truth.sites.size(); ++s)
    for (std::size_t i = 1; i < truth.sites[s].paths[0].samples.size(); ++i) {
      const CurveSample& ours = curves.sites[s].paths[0].samples[i];
      const double error = std::abs(ours.force[2] - truth.sites[s].paths[0].samples[i].force[2]);
      largest = std::max(largest, error / norm(ours.force));
      bounds += ours.mesh_error / norm(ours.force);
      covered += error <= ours.mesh_error ? 1 : 0;
      ++compared;
    }
  EXPECT_LT(largest, 0.06);
  EXPECT_GE(covered, 0.9 * compared) << covered << " of " << compared;
  EXPECT_LT(bounds / compared, 3 * largest);
}

/// The lateral paths of a pressed site as well, along each direction by itself.
TEST(FinerMesh, TellsTheDifferenceOfLateralForces) {
  const Body body = uneven_block();
  CampaignSettings settings = pressed();
  settings.indentation.increments = 2;
  settings.indentation.lateral_depths = {0.001};
  settings.indentation.lateral_travel = 0.0005;
  settings.indentation.lateral_increments = 2;
  settings.indentation.azimuths = {0, 1.5};
  CampaignReport report;
  settings.sites = {test::site_nearest(body, 0.001, 0.004), test::site_nearest(body, 0.008, 0)};
  Curves curves = run_campaign(body, settings, report);
  std::vector<std::int64_t> done;
  settings.progress = [&](const CampaignProgress& p) {
    EXPECT_EQ(p.total, 1);
    done.push_back(p.done);
  };
  press_on_finer_mesh(body, settings, {curves.sites[1].vertex}, curves, report);
  EXPECT_EQ(done, (std::vector<std::int64_t>{0, 1}));
  ASSERT_EQ(curves.sites[1].paths.size(), 3U);
  for (const CurvePath& path : curves.sites[1].paths)
    for (std::size_t i = 1; i < path.samples.size(); ++i)
      EXPECT_LT(std::abs(path.samples[i].mesh_difference),
                0.8 * std::abs(response_force(path, path.samples[i])));
  fitting::bound_mesh_errors(curves);
  for (const CurvePath& path : curves.sites[0].paths) {
    EXPECT_TRUE(std::isnan(path.samples.back().mesh_difference));
    EXPECT_GT(path.samples.back().mesh_error, 0);
  }
}

}  // namespace
}  // namespace palpate::fem
