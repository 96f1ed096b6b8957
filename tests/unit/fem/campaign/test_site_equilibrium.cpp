// SPDX-License-Identifier: AGPL-3.0-or-later
// Which solver finds the equilibrium of a site, and how closely.
#include "fem/campaign/site_equilibrium.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "fem/contact/increment_work.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kRadius = 0.005;  // m

Body block() {
  return test::make_block(test::graded(0.02, 0.005, 0.0025, 1.6),
                          test::graded(0.02, 0.005, 0.0025, 1.6),
                          {-0.02, -0.012, -0.006, -0.0025, 0});
}

CampaignSettings pressing() {
  CampaignSettings settings;
  settings.materials = {{"tissue", {10e3, 0.45}}};
  settings.indentation.tool.radius = kRadius;
  return settings;
}

/// A site of a campaign with its tool at a depth.
class Site {
 public:
  Site(const CampaignSettings& settings, Engine engine, SiteMesh mesh, double window_tool = kRadius)
      : context_(body_, settings, engine),
        site_body_(context_.model, context_.rest, Eigen::Vector3d::Zero(),
                   ToolGeometry{ToolShape::Sphere, window_tool, 0, 0}, mesh),
        contact_(site_body_.mesh(), Eigen::Vector3d::Zero(), 0.012, context_.contact_stiffness) {
    if (context_.rest_factor) {
      pool_.emplace(*context_.rest_factor, 1);
      member_.emplace(*pool_);
    }
    equilibrium_.emplace(context_, site_body_, member_ ? &*member_ : nullptr);
  }

  NewtonResult press(double depth, bool direct_allowed, Displacement& u) {
    Tool tool;
    tool.geometry.radius = kRadius;
    tool.tip = Eigen::Vector3d(3e-4, -2e-4, -depth);
    contact_.move_to(tool);
    return equilibrium_->solve(contact_, direct_allowed, u);
  }
  Displacement rest() const { return site_body_.rest(); }
  Eigen::Vector3d force(const Displacement& u) const { return contact_.tool_force(u); }
  /// Residual over the force of the tool.
  double residual(const Displacement& u) const {
    return evaluate(site_body_.whole(), contact_, u).residual.norm() / force(u).norm();
  }
  Eigen::Vector3d tip() const { return contact_.tool().tip; }
  std::optional<double> work(const Eigen::Vector3d& from, const Displacement& before,
                             const Displacement& after) {
    return work_between(contact_, site_body_.whole(), from, before, after);
  }

 private:
  const Body body_ = block();
  CampaignContext context_;
  SiteBody site_body_;
  ToolContact contact_;
  std::optional<SolvePool> pool_;
  std::optional<SolvePool::Member> member_;
  std::optional<SiteEquilibrium> equilibrium_;
};

TEST(SiteEquilibrium, IsWithinTheToleranceOfTheForceWithEitherSolver) {
  const CampaignSettings settings = pressing();
  const double tolerance = settings.indentation.force_tolerance;
  Site shared(settings, Engine::SharedFactor, SiteMesh::Window);
  Site direct(settings, Engine::Direct, SiteMesh::WholeBody);
  Displacement u = shared.rest(), v = direct.rest();
  for (const double depth : {0.0007, 0.0014, 0.002}) {
    ASSERT_TRUE(shared.press(depth, false, u).converged);
    ASSERT_TRUE(direct.press(depth, false, v).converged);
    EXPECT_LE(shared.residual(u), 0.5 * tolerance);
    EXPECT_LE(direct.residual(v), tolerance);
    EXPECT_LT((shared.force(u) - direct.force(v)).norm(), 2 * tolerance * direct.force(v).norm());
  }
}

/// The window of a tool of 0.5 mm has next to none of the contact of one of 5 mm.
TEST(SiteEquilibrium, FallsBackToTheWholeBodyWhereTheSharedFactorFails) {
  CampaignSettings settings = pressing();
  settings.indentation.force_tolerance = 1e-8;
  Site site(settings, Engine::SharedFactor, SiteMesh::Window, 0.0005);
  Displacement u = site.rest();
  const NewtonResult refused = site.press(0.002, false, u);
  ASSERT_FALSE(refused.converged);
  EXPECT_FALSE(refused.reason.empty());
  EXPECT_TRUE(u == site.rest());  // a failure leaves no half-way state
  const NewtonResult allowed = site.press(0.002, true, u);
  ASSERT_TRUE(allowed.converged) << allowed.reason;
  EXPECT_GT(allowed.iterations, refused.iterations);  // those of both solvers are counted
  EXPECT_LE(site.residual(u), 1e-8);
}

/// Against the trapezoidal rule, whose error over a step of a quarter of the depth is a few tenths
/// of a percent.
TEST(SiteEquilibrium, HasStatesBetweenWhichTheToolDoesTheWorkOfItsMeanForce) {
  for (const Engine engine : {Engine::Direct, Engine::SharedFactor}) {
    const bool direct = engine == Engine::Direct;
    Site site(pressing(), engine, direct ? SiteMesh::WholeBody : SiteMesh::Window);
    Displacement u = site.rest();
    ASSERT_TRUE(site.press(0.0010, false, u).converged);
    const Displacement before = u;
    const Eigen::Vector3d from = site.tip(), first = site.force(u);
    ASSERT_TRUE(site.press(0.0013, false, u).converged);
    const auto work = site.work(from, before, u);
    ASSERT_TRUE(work.has_value());
    const double trapezoid = 0.5 * (first + site.force(u)).dot(site.tip() - from);
    EXPECT_NEAR(*work, trapezoid, 0.01 * trapezoid);
  }
}

TEST(SiteEquilibrium, KeepsMoreCurvaturePairsForANoSlipPressAndABodyOnSprings) {
  Body body = block();
  CampaignSettings settings = pressing();
  EXPECT_EQ(pairs_needed(CampaignContext(body, settings, Engine::Direct)),
            SharedFactorSolver::kFewPairs);
  settings.indentation.friction = ToolFriction::NoSlip;
  EXPECT_EQ(pairs_needed(CampaignContext(body, settings, Engine::Direct)),
            SharedFactorSolver::kMostPairs);
  settings.indentation.friction = ToolFriction::Frictionless;
  body.foundation.push_back({0, 1e5, 1e5});
  EXPECT_EQ(pairs_needed(CampaignContext(body, settings, Engine::Direct)),
            SharedFactorSolver::kMostPairs);
}

}  // namespace
}  // namespace palpate::fem
