// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "fem/campaign/campaign.hpp"
#include "fem/campaign/indentation.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

Body soft_block() {
  return test::make_block(test::graded(0.03, 0.005, 0.0025, 1.5),
                          test::graded(0.03, 0.005, 0.0025, 1.5),
                          {-0.03, -0.02, -0.012, -0.006, -0.003, 0});
}

std::int32_t centre_vertex(const Body& body) {
  std::int32_t best = 0;
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const auto r = [&](std::size_t i) {
      const Vec3& x = body.nodes[to_index(body.response.node[i])];
      return std::hypot(x[0], x[1]);
    };
    if (r(v) < r(static_cast<std::size_t>(best))) best = static_cast<std::int32_t>(v);
  }
  return best;
}

CampaignSettings settings() {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.49}}};
  s.indentation.depth = 0.004;
  s.indentation.increments = 8;
  s.indentation.lateral_depths = {0.002};
  s.indentation.lateral_travel = 0.002;
  s.indentation.lateral_increments = 4;
  return s;
}

class Indentation : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    body_ = new Body(soft_block());
    const CampaignContext context(*body_, settings(), Engine::SharedFactor);
    curves_ = new SiteCurves(solve_site(context, centre_vertex(*body_), nullptr));
  }
  static void TearDownTestSuite() {
    delete body_;
    delete curves_;
  }
  static Body* body_;
  static SiteCurves* curves_;
};
Body* Indentation::body_ = nullptr;
SiteCurves* Indentation::curves_ = nullptr;

TEST_F(Indentation, CompletesBothPaths) {
  ASSERT_EQ(curves_->status, SiteStatus::Complete) << curves_->reason;
  ASSERT_EQ(curves_->paths.size(), 2u);
  EXPECT_DOUBLE_EQ(curves_->paths[0].samples.back().displacement, 0.004);
  EXPECT_DOUBLE_EQ(curves_->paths[1].samples.back().displacement, 0.002);
  EXPECT_EQ(curves_->paths[0].samples.front().force, (Vec3{0, 0, 0}));
}

TEST_F(Indentation, PressesAnyPointOfTheSurface) {
  const std::int32_t centre = centre_vertex(*body_);
  const Vec3 at_centre = body_->nodes[to_index(body_->response.node[to_index(centre)])];
  CampaignSettings s = settings();
  s.indentation.lateral_depths.clear();
  s.indentation.depth = 0.002;  // in the same steps
  s.indentation.increments = 4;
  // A third of an element off the node, on a block that is the same there but for its far sides.
  s.points = {{at_centre, body_->response.inward[to_index(centre)]},
              {at_centre + Vec3{0.0008, 0.0005, 0}, body_->response.inward[to_index(centre)]}};
  CampaignReport report;
  const Curves curves = run_campaign(*body_, s, report);
  ASSERT_EQ(curves.sites.size(), 2u);
  const auto& node = curves_->paths[0].samples;
  for (std::size_t i = 1; i < curves.sites[0].paths[0].samples.size(); ++i) {
    EXPECT_EQ(curves.sites[0].paths[0].samples[i].force, node[i].force);
    EXPECT_NE(curves.sites[1].paths[0].samples[i].force, node[i].force);
    EXPECT_NEAR(curves.sites[1].paths[0].samples[i].force[2], node[i].force[2],
                0.05 * std::abs(node[4].force[2]));
  }
  s.points[1].inward = {0, 0, -2};
  EXPECT_ANY_THROW(run_campaign(*body_, s, report));
}

void expect_snap_in_few_iterations(const std::vector<CurveSample>& samples) {
  bool snapped = false;
  double work = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const CurveSample &before = samples[i - 1], &now = samples[i];
    EXPECT_LE(now.iterations, 10) << "increment " << i;
    EXPECT_GT(norm(now.force), norm(before.force));
    snapped |= now.min_jacobian > 1.5 * before.min_jacobian;
    work += 0.5 * (norm(before.force) + norm(now.force)) * (now.displacement - before.displacement);
    // What is stored is less than the work of the tool by what the snap has set free.
    EXPECT_LT(now.strain_energy, 1.02 * work) << "increment " << i;
  }
  EXPECT_TRUE(snapped);
  EXPECT_GT(samples.back().strain_energy, 0.9 * work);
}

/// Pressed obliquely, the sharp edge of a block first folds and then snaps flat under the tool: the
/// stiffness of the solid is indefinite there, and steps of a stiffened model are far too short.
TEST(IndentationOfAnEdge, GoesThroughASnapInFewIterations) {
  constexpr double kHalf = 0.012;
  const Body block = test::make_block(test::even(-kHalf, kHalf, 12), test::even(-kHalf, kHalf, 12),
                                      test::even(-kHalf, 0, 6));
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.495}}};
  s.indentation.tool.radius = 0.0034;
  s.indentation.depth = 0.0021;
  s.indentation.increments = 10;
  s.indentation.lateral_depths.clear();
  s.indentation.refine_under_tool = IndentationSettings::kByContact;
  s.indentation.size_over_contact = 1.5;  // the mesh whose iterations are counted
  const double c = std::sqrt(0.5);
  for (const double y : {0.001, 0.0015, 0.0019}) s.points.push_back({{kHalf, y, 0}, {-c, 0, -c}});
  CampaignReport report;
  for (const SiteCurves& site : run_campaign(block, s, report).sites) {
    ASSERT_EQ(site.status, SiteStatus::Complete) << site.reason;
    expect_snap_in_few_iterations(site.paths[0].samples);
  }
}

/// An ear: a plate that stands on its edge and bends as a whole under the tool, by two and four
/// times its thickness, so that its stiffness at rest says little of how the rest of the body
/// follows.
TEST(IndentationOfAnEar, BendsItToTheDepthThatIsAskedFor) {
  constexpr double kWidth = 0.02, kArm = 0.034, kYoung = 10e3, kPoisson = 0.495;
  for (const double thickness : {0.004, 0.002}) {
    const Body ear =
        test::make_block(test::even(-thickness, 0, 2), test::even(-0.5 * kWidth, 0.5 * kWidth, 4),
                         test::even(0, 0.04, 12));
    CampaignSettings s;
    s.materials = {{"tissue", {kYoung, kPoisson}}};
    s.indentation.tool.radius = 0.006;
    s.indentation.depth = 0.008;
    s.indentation.increments = 6;
    s.indentation.lateral_depths.clear();
    s.indentation.refine_under_tool = IndentationSettings::kByContact;
    s.points = {{{0, 0.001, kArm}, {-1, 0, 0}}};
    CampaignReport report;
    const SiteCurves site = run_campaign(ear, s, report).sites.at(0);
    ASSERT_EQ(site.status, SiteStatus::Complete) << thickness << ": " << site.reason;
    const CurveSample &first = site.paths[0].samples.at(1), &end = site.paths[0].samples.back();
    EXPECT_NEAR(end.tool_work, end.strain_energy + end.contact_energy, 5e-3 * end.strain_energy);
    // At first between a beam and a plate that cannot narrow.
    const double beam = 3 * kYoung * kWidth * std::pow(thickness / kArm, 3) / 12;
    EXPECT_GT(norm(first.force), beam * first.displacement);
    EXPECT_LT(norm(first.force), beam / (1 - kPoisson * kPoisson) * first.displacement);
  }
}

TEST_F(Indentation, WorkOfTheToolEqualsTheStoredEnergy) {
  for (const auto& path : curves_->paths) {
    const CurveSample& end = path.samples.back();
    EXPECT_NEAR(end.tool_work, end.strain_energy + end.contact_energy, 5e-3 * end.strain_energy);
    if (path.kind == PathKind::Normal) {  // little is stored in the penalty
      EXPECT_LT(end.contact_energy, 5e-3 * end.strain_energy);
    }
  }
}

TEST_F(Indentation, ForceIsTheDerivativeOfTheStrainEnergy) {
  // Independent of the running integral: the middle of three energies.
  const auto& s = curves_->paths[0].samples;
  for (std::size_t i = 3; i + 1 < s.size(); ++i) {
    const double slope = (s[i + 1].strain_energy - s[i - 1].strain_energy) /
                         (s[i + 1].displacement - s[i - 1].displacement);
    EXPECT_NEAR(-s[i].force[2], slope, 0.03 * slope);
  }
}

double volume_at(const Body& body, const Displacement& u) {
  double sum = 0;
  for (const Tetrahedron& t : body.tetrahedra) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
      const Vec3& x = body.nodes[to_index(t[k])];
      return Eigen::Vector3d(x[0], x[1], x[2]) + u.col(t[k]);
    };
    sum += (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0)) / 6;
  }
  return sum;
}

// A press squeezes a compressible block and moves an incompressible one. Of the first the volume
// change is that of the straight tetrahedra between the displaced nodes, but for their curvature.
TEST_F(Indentation, VolumeChangeIsThatOfTheDisplacedBody) {
  CampaignSettings s = settings();
  s.materials = {{"tissue", {10e3, 0.3}}};
  Displacement pressed;
  const CampaignContext context(*body_, s, Engine::SharedFactor);
  const SiteCurves curves = solve_site(context, centre_vertex(*body_), &pressed);
  const auto& normal = curves.paths[0].samples;
  EXPECT_EQ(normal.front().volume_change, 0);
  const double change = normal.back().volume_change;
  const double at_rest = volume_at(*body_, Displacement::Zero(3, pressed.cols()));
  EXPECT_LT(change, 0);
  EXPECT_NEAR(change, volume_at(*body_, pressed) - at_rest, 0.1 * std::abs(change));
  EXPECT_LT(std::abs(curves_->paths[0].samples.back().volume_change), 0.1 * std::abs(change));
  EXPECT_EQ(curves.paths[1].samples.front().volume_change, normal[4].volume_change);
}

TEST_F(Indentation, PenetrationIsSmall) {
  // Half a percent of the depth, set by the penalty.
  for (const auto& path : curves_->paths)
    for (const auto& sample : path.samples) EXPECT_LT(sample.penetration, 2e-5);
}

TEST_F(Indentation, LateralForceOpposesTheMotionAndGrows) {
  const auto& lateral = curves_->paths[1];
  const double end = dot(lateral.samples.back().force, lateral.direction);
  EXPECT_GT(end, 0);
  double last = -1e-9;
  for (const auto& sample : lateral.samples) {
    const double f = dot(sample.force - lateral.samples.front().force, lateral.direction);
    EXPECT_GE(f, last);
    last = f;
  }
}

/// What touches sticks from then on, however long the increment goes on: a tool that sticks feels
/// 4 % more than one without friction, and most of that in two increments as well.
TEST_F(Indentation, OfAToolThatSticksBarelyDependsOnItsIncrements) {
  const auto force = [&](int increments) {
    CampaignSettings s = settings();
    s.indentation.friction = increments > 0 ? ToolFriction::NoSlip : ToolFriction::Frictionless;
    s.indentation.increments = std::max(1, increments);
    s.indentation.azimuths.clear();
    s.indentation.lateral_depths.clear();
    const CampaignContext context(*body_, s, Engine::SharedFactor);
    const SiteCurves site = solve_site(context, centre_vertex(*body_), nullptr);
    EXPECT_EQ(site.status, SiteStatus::Complete) << site.reason;
    return norm(site.paths.front().samples.back().force);
  };
  const double fine = force(32);
  EXPECT_LT(force(0), 0.97 * fine);
  EXPECT_NEAR(force(2), fine, 0.012 * fine);
  EXPECT_NEAR(force(4), fine, 0.005 * fine);
}

TEST_F(Indentation, DragsAcrossItsOnlyAzimuthAtTheMiddleDepth) {
  CampaignSettings s = settings();
  s.indentation.increments = 4;
  s.indentation.lateral_depths = {0.001, 0.002, 0.003};
  s.indentation.drag_across = true;
  const auto paths_with = [&](const std::vector<double>& azimuths) {
    s.indentation.azimuths = azimuths;
    const CampaignContext context(*body_, s, Engine::SharedFactor);
    const SiteCurves site = solve_site(context, centre_vertex(*body_), nullptr);
    EXPECT_EQ(site.status, SiteStatus::Complete) << site.reason;
    return site.paths;
  };
  const auto paths = paths_with({0.3});
  ASSERT_EQ(paths.size(), 5u);
  const CurvePath &along = paths[2], &across = paths[4];
  EXPECT_EQ(across.lateral_depth, 0.002);
  EXPECT_NEAR(dot(across.direction, along.direction), 0, 1e-12);
  EXPECT_NEAR(dot(across.direction, paths[0].direction), 0, 1e-12);
  ASSERT_EQ(across.samples.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(across.samples[i].displacement, along.samples[i].displacement);
    // The block is the same in both directions.
    EXPECT_NEAR(dot(across.samples[i].force, across.direction),
                dot(along.samples[i].force, along.direction),
                0.03 * norm(along.samples.front().force));
  }
  EXPECT_EQ(paths_with({0, 0.5 * M_PI}).size(), 7u);
}

TEST_F(Indentation, ForceIsThatOfNewtonOnTheWholeBodyWithinTheTolerance) {
  const double tolerance = settings().indentation.force_tolerance;
  CampaignSettings exact = settings();
  exact.indentation.force_tolerance = 1e-3 * tolerance;
  const CampaignContext context(*body_, exact, Engine::Direct);
  const SiteCurves direct = solve_site(context, centre_vertex(*body_), nullptr);
  ASSERT_EQ(direct.paths.size(), 2u);
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t i = 1; i < direct.paths[p].samples.size(); ++i) {
      const Vec3& expected = direct.paths[p].samples[i].force;
      EXPECT_LT(norm(curves_->paths[p].samples[i].force - expected), tolerance * norm(expected));
    }
}

}  // namespace
}  // namespace palpate::fem
