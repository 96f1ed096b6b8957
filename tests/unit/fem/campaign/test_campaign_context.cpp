// SPDX-License-Identifier: AGPL-3.0-or-later
// Sites of a body on springs and of a body under its weight.
#include "fem/campaign/campaign_context.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/campaign/campaign.hpp"
#include "fem/campaign/indentation.hpp"
#include "fem/mesh/quadratic_mesh.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "format/edge.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/equilibrium.hpp"

namespace palpate::fem {
namespace {

Body sprung_block(double stiffness) {
  Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                               test::even(-0.012, 0, 3));
  body.fixed_nodes.clear();
  for (std::size_t f = 0; f < body.boundary.size(); ++f) {
    const Triangle& facet = body.boundary[f];
    const auto z = [&](std::size_t c) { return body.nodes[to_index(facet[c])][2]; };
    if (z(0) + z(1) + z(2) > -0.0359) continue;
    body.foundation.push_back({static_cast<std::int32_t>(f), stiffness, stiffness});
  }
  return body;
}

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

void expect_same_forces(const SiteCurves& a, const SiteCurves& b, double tolerance) {
  ASSERT_EQ(a.paths.size(), b.paths.size());
  for (std::size_t p = 0; p < a.paths.size(); ++p) {
    ASSERT_EQ(a.paths[p].samples.size(), b.paths[p].samples.size());
    const Vec3 x = a.paths[p].samples.back().force, y = b.paths[p].samples.back().force;
    EXPECT_LT(norm(x - y), tolerance * norm(x));
  }
}

TEST(BodyOnSprings, BalancesForceAndWorkOfTheTool) {
  constexpr double kStiffness = 3e5;
  const Body body = sprung_block(kStiffness);
  const CampaignSettings settings = pressing({10e3, 0.45});
  Displacement u;
  const SiteCurves shared = press(body, settings, Engine::SharedFactor, &u);
  ASSERT_EQ(shared.status, SiteStatus::Complete) << shared.reason;
  expect_same_forces(press(body, settings, Engine::Direct), shared, 1e-3);
  const CurveSample& end = shared.paths.front().samples.back();
  // The mean of a quadratic field over a facet is that of its mid-edge values.
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  double carried = 0, stored = 0;
  for (const SprungFacet& sprung : body.foundation) {
    const Facet& facet = mesh.facets[to_index(sprung.facet)];
    constexpr double kFacet = 0.008 * 0.008 / 2;
    for (const std::size_t m : {3u, 4u, 5u}) {
      carried -= kStiffness * kFacet / 3 * u(2, facet[m]);
      stored += 0.5 * kStiffness * kFacet / 3 * u.col(facet[m]).squaredNorm();
    }
  }
  EXPECT_NEAR(-end.force[2], carried, 2e-3 * carried);
  EXPECT_GT(stored, 0.1 * end.tool_work);  // or the balance below would not test it
  for (const CurvePath& path : shared.paths) {
    const CurveSample& last = path.samples.back();
    EXPECT_NEAR(last.tool_work, last.strain_energy + last.contact_energy, 5e-3 * last.tool_work);
  }
}

/// A body on springs far softer than itself moves almost as a rigid one: F = k A depth.
TEST(BodyOnSprings, IsTheirStiffnessWhereItIsMuchStiffer) {
  constexpr double kStiffness = 2e4, kArea = 0.032 * 0.032;
  CampaignSettings settings = pressing({1e6, 0.45});
  settings.indentation.increments = 5;
  settings.indentation.lateral_depths.clear();
  const SiteCurves site = press(sprung_block(kStiffness), settings, Engine::SharedFactor);
  ASSERT_EQ(site.status, SiteStatus::Complete) << site.reason;
  // The tool travels 20 um before a quadrature point of the coarse facets touches it: compare
  // slopes.
  const auto& samples = site.paths.front().samples;
  for (std::size_t i = 2; i < samples.size(); ++i) {
    const double slope = (samples[i - 1].force[2] - samples[i].force[2]) /
                         (samples[i].displacement - samples[i - 1].displacement);
    EXPECT_LE(slope, kStiffness * kArea * (1 + 2e-3));
    EXPECT_GE(slope, 0.97 * kStiffness * kArea);
  }
}

/// Mean displacement of the top along z.
double top_displacement(const Body& body, const Displacement& u) {
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  double sum = 0;
  int count = 0;
  for (int node = 0; node < mesh.nodes(); ++node) {
    if (mesh.X(2, node) < mesh.X.row(2).maxCoeff() - 1e-9) continue;
    sum += u(2, node);
    ++count;
  }
  return sum / count;
}

/// Work of the tool = change of the strain energy less the work of gravity, both computed here by
/// other means; the forces are those of the tool alone.
TEST(BodyUnderItsWeight, StartsFromEquilibriumAndBalancesItsEnergy) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.024, 0, 4));
  CampaignSettings settings = pressing({4e3, 0.45});
  const SiteCurves light = press(body, settings, Engine::SharedFactor);
  settings.gravity = {{0, 3, -9.81}, 1000};
  const CampaignContext context(body, settings, Engine::SharedFactor);
  const double lowered = -top_displacement(body, context.rest);
  EXPECT_GT(lowered, 2e-4);
  Displacement u;
  const SiteCurves heavy = solve_site(context, test::site_nearest(body), &u);
  ASSERT_EQ(heavy.status, SiteStatus::Complete) << heavy.reason;
  expect_same_forces(press(body, settings, Engine::Direct), heavy, 1e-3);

  const SolidModel weightless(body, {make_law({4e3, 0.45}, "t")});
  const auto loads = test::body_loads(make_quadratic_mesh(body), [](const Eigen::Vector3d&) {
    return Eigen::Vector3d(0, 3000, -9810);
  });
  const double gravity_work = loads.cwiseProduct(u - context.rest).sum();
  const double strain = weightless.energy(u).energy - weightless.energy(context.rest).energy;
  const CurvePath& path = heavy.paths.front();
  const CurveSample& end = path.samples.back();
  EXPECT_GT(gravity_work, 0.02 * end.tool_work);  // or the balance would not see it
  EXPECT_NEAR(end.tool_work + gravity_work, strain + end.contact_energy, 5e-3 * end.tool_work);
  EXPECT_NEAR(end.strain_energy, strain - gravity_work, 1e-6 * end.tool_work);
  for (const CurvePath& each : heavy.paths) {
    const CurveSample& last = each.samples.back();
    EXPECT_NEAR(last.tool_work, last.strain_energy + last.contact_energy, 5e-3 * last.tool_work);
  }
  // The path starts at the displaced surface: at the undeformed one the tool would be off it.
  EXPECT_EQ(path.samples.front().displacement, 0);
  EXPECT_EQ(norm(path.samples.front().force), 0);
  EXPECT_EQ(path.samples.front().strain_energy, 0);
  for (std::size_t i = 1; i < path.samples.size(); ++i) {
    const double without = norm(light.paths.front().samples[i].force);
    EXPECT_NEAR(norm(path.samples[i].force), without, 0.15 * without);
    EXPECT_NE(norm(path.samples[i].force), without);
  }
}

/// The tool travels 20 um before a quadrature point of the coarse facets touches it. Until then the
/// residual is round-off of the weight, and there is no tool force to compare it with.
TEST(BodyUnderItsWeight, HasNoToolForceBeforeTheFirstContact) {
  const Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                                     test::even(-0.024, 0, 4));
  CampaignSettings settings = pressing({4e3, 0.45});
  settings.gravity = {{0, 0, -9.81}, 1000};
  settings.indentation.depth = 5e-6;
  settings.indentation.increments = 2;
  settings.indentation.lateral_depths.clear();
  for (const Engine engine : {Engine::Direct, Engine::SharedFactor}) {
    const SiteCurves site = press(body, settings, engine);
    ASSERT_EQ(site.status, SiteStatus::Complete) << site.reason;
    EXPECT_EQ(norm(site.paths.front().samples.back().force), 0);
  }
}

/// The body as it lies at the end of a sag.
Body lying(const Body& body, const CampaignContext& sagging) {
  const QuadraticMesh& mesh = sagging.model.mesh();
  const Eigen::Matrix3Xd position = mesh.X + sagging.rest;
  Body given = body;
  for (std::size_t i = 0; i < given.nodes.size(); ++i)
    given.nodes[i] = to_vec3(position.col(static_cast<Eigen::Index>(i)));
  for (const Edge& ends : edges_of(given.boundary))
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
      if (edge_between(mesh.edges[e][0], mesh.edges[e][1]) == ends)
        given.curved_edges.push_back(
            {ends, to_vec3(position.col(mesh.corners() + static_cast<Eigen::Index>(e)))});
  return given;
}

class BodyThatSags : public testing::Test {
 protected:
  Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                               test::even(-0.024, 0, 4));
  CampaignSettings settings = [] {
    CampaignSettings s = pressing({2e3, 0.45});
    s.gravity = {{0, 3, -9.81}, 1000};
    return s;
  }();
  std::int32_t vertex = test::site_nearest(body);

  /// The settings for the shape that lies.
  CampaignSettings as_it_lies() const {
    CampaignSettings s = settings;
    s.gravity.shape = GivenShape::Loaded;
    return s;
  }

  static void expect_same_presses(const SiteCurves& one, const SiteCurves& other) {
    ASSERT_EQ(one.status, SiteStatus::Complete) << one.reason;
    ASSERT_EQ(other.status, SiteStatus::Complete) << other.reason;
    for (std::size_t p = 0; p < one.paths.size(); ++p)
      for (std::size_t i = 1; i < one.paths[p].samples.size(); ++i) {
        const CurveSample &a = one.paths[p].samples[i], &b = other.paths[p].samples[i];
        EXPECT_LT(norm(a.force - b.force), 1e-3 * norm(a.force) + 1e-6);
        EXPECT_NEAR(b.tool_work, b.strain_energy + b.contact_energy, 5e-3 * b.tool_work + 1e-9);
      }
  }
};

/// A body given as it lies under its weight is pressed as the body that sags to that shape.
TEST_F(BodyThatSags, GivenAsItLiesIsPressedAsTheBodyThatSagsToIt) {
  const CampaignContext sagging(body, settings, Engine::SharedFactor);
  const Body given = lying(body, sagging);
  settings = as_it_lies();
  const CampaignContext loaded(given, settings, Engine::SharedFactor);
  ASSERT_TRUE(loaded.unloaded);
  const Vec3 site = given.nodes[to_index(given.response.node[to_index(vertex)])];
  EXPECT_EQ(to_vec3(loaded.rest_position(site)), site);
  const Vec3 at_rest = body.nodes[to_index(body.response.node[to_index(vertex)])];
  EXPECT_LT((loaded.reference_position(site) - to_eigen(at_rest)).norm(), 1e-7);
  EXPECT_GT(norm(site - at_rest), 1e-3);

  Displacement u, v;
  const SiteCurves one = solve_site(sagging, vertex, &u), other = solve_site(loaded, vertex, &v);
  expect_same_presses(one, other);
  // Fields are displacements from the given shape.
  const DeformedState state = deformed_state(given, settings, vertex);
  const std::int32_t node = given.response.node[to_index(vertex)];
  const Eigen::Vector3d moved = u.col(node) - sagging.rest.col(node);
  EXPECT_LT((v.col(node) - loaded.rest.col(node) - moved).norm(), 1e-3 * moved.norm());
  EXPECT_LT((to_eigen(state.displacement[to_index(node)]) - moved).norm(), 1e-3 * moved.norm());
}

/// The same with elements that are refined under the tool and sag further.
TEST_F(BodyThatSags, RefinedAndGivenAsItLiesIsPressedAsTheBodyThatSagsToIt) {
  // Without equal lengths, which rounding would compare: both are then refined in the same way.
  test::deform(body, [](const Vec3& x) {
    return Vec3{1.05 * x[0] + 0.11 * x[1] + 0.05 * x[2], 1.07 * x[1] + 0.06 * x[2], 1.03 * x[2]};
  });
  const Body given = lying(body, CampaignContext(body, settings, Engine::SharedFactor));
  settings.indentation.increments = 4;
  settings.indentation.lateral_increments = 3;
  settings.indentation.refine_under_tool = 1;
  Displacement u, rest;
  const SiteCurves one =
      solve_site(CampaignContext(body, settings, Engine::SharedFactor), vertex, &u, &rest);
  settings = as_it_lies();
  const SiteCurves other =
      solve_site(CampaignContext(given, settings, Engine::SharedFactor), vertex, nullptr);
  expect_same_presses(one, other);
  const DeformedState state = deformed_state(given, settings, vertex);
  const std::int32_t node = given.response.node[to_index(vertex)];
  const Eigen::Vector3d moved = u.col(node) - rest.col(node);
  EXPECT_LT((to_eigen(state.displacement[to_index(node)]) - moved).norm(), 1e-3 * moved.norm());
}

}  // namespace
}  // namespace palpate::fem
