// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies that rotate as a whole under the tool: on springs far softer than themselves, or on a
// small support.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "fem/campaign/indentation.hpp"
#include "fem/solid/rigid_motion.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

bool at_base(const Body& body, std::int32_t node) {
  return body.nodes[to_index(node)][2] < -0.0159;
}

Body block() {
  return test::make_block(test::even(-0.02, 0.02, 8), test::even(-0.02, 0.02, 8),
                          test::even(-0.016, 0, 4));
}

Body on_springs(double stiffness) {
  Body body = block();
  body.fixed_nodes.clear();
  for (std::size_t f = 0; f < body.boundary.size(); ++f) {
    const Triangle& facet = body.boundary[f];
    if (at_base(body, facet[0]) && at_base(body, facet[1]) && at_base(body, facet[2]))
      body.foundation.push_back({static_cast<std::int32_t>(f), stiffness, stiffness});
  }
  return body;
}

Body on_small_support() {
  Body body = block();
  body.fixed_nodes.clear();
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(body.nodes.size()); ++node) {
    const Vec3& x = body.nodes[to_index(node)];
    if (at_base(body, node) && std::hypot(x[0], x[1]) < 0.0051) body.fixed_nodes.push_back(node);
  }
  return body;
}

CampaignSettings settings(double young) {
  CampaignSettings s;
  s.materials = {{"tissue", {young, 0.45}}};
  s.indentation.tool.radius = 0.005;
  s.indentation.depth = 0.003;
  s.indentation.increments = 10;
  s.indentation.lateral_depths = {0.002};
  s.indentation.lateral_travel = 0.002;
  s.indentation.lateral_increments = 5;
  s.points = {{{0.0121, 0.0083, 0}, {0, 0, -1}}};
  return s;
}

int iterations_of(const SiteCurves& site) {
  int sum = 0;
  for (const CurvePath& path : site.paths)
    for (const CurveSample& sample : path.samples) sum += sample.iterations;
  return sum;
}

/// Both engines complete with the same forces. @return iterations with the shared factor.
int press_both_ways(const Body& body, const CampaignSettings& settings) {
  const auto press = [&](Engine engine) {
    SiteCurves site = solve_site(CampaignContext(body, settings, engine), 0, nullptr);
    EXPECT_EQ(site.status, SiteStatus::Complete) << site.reason;
    return site;
  };
  const SiteCurves shared = press(Engine::SharedFactor), direct = press(Engine::Direct);
  for (std::size_t p = 0; p < direct.paths.size(); ++p) {
    const Vec3 a = shared.paths[p].samples.back().force, b = direct.paths[p].samples.back().force;
    EXPECT_LT(norm(a - b), 1e-3 * norm(b));
  }
  return iterations_of(shared);
}

/// A rotation applied along its tangent stretches the body; as a rotation it stores no energy.
TEST(RigidMotion, OfARotatingStepStoresNoEnergy) {
  Body body = block();
  body.fixed_nodes.clear();
  const SolidModel model(body, {make_law({10e3, 0.45}, "t")});
  const Eigen::Vector3d w(0.1, -0.2, 0.05), v(1e-3, 2e-3, 0);
  Eigen::VectorXd d(model.pattern().n);
  for (int node = 0; node < model.mesh().nodes(); ++node)
    d.segment<3>(model.equation(node)) = v + w.cross(Eigen::Vector3d(model.mesh().X.col(node)));
  Displacement along = Displacement::Zero(3, model.mesh().nodes()), rotated = along;
  add_step(model, 1, d, along);
  add_rotating_step(model, 1, d, rotated);
  EXPECT_GT(model.energy(along).energy, 1e-5);
  EXPECT_NEAR(model.energy(rotated).energy, 0, 1e-14);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
  EXPECT_LT((mean_rotation(model.mesh(), rotated) - R).norm(), 1e-12);
}

/// Without the rotation of the stiffness at rest, and with linear steps, it needs more.
TEST(RigidMotion, OnSoftSpringsNeedsFewIterations) {
  EXPECT_LT(press_both_ways(on_springs(2e4), settings(100e3)), 300);
}

TEST(RigidMotion, OnASmallSupportNeedsFewIterations) {
  EXPECT_LT(press_both_ways(on_small_support(), settings(10e3)), 250);
}

}  // namespace
}  // namespace palpate::fem
