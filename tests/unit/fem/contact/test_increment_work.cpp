// SPDX-License-Identifier: AGPL-3.0-or-later
// The work of the tool over one increment, against a closed form and against
// what must have become of it.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "fem/contact/increment_work.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kRadius = 0.005, kContact = 1e8;

/// A surface of facets of 3 mm on a linear solid: a stiffness S of the patch under the tool, of the
/// order of the elements, by which every unknown feels every other.
struct LinearSolid {
  Body body = test::make_block(test::even(-0.012, 0.012, 8), test::even(-0.012, 0.012, 8),
                               test::even(-0.006, 0, 1));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")}};
  ToolContact contact{
      model.mesh(), Eigen::Vector3d::Zero(), 0.008, {kContact, 1e4}};  // the upper face

  Displacement rest = Displacement::Zero(3, model.mesh().nodes());
  Tool tool;

  explicit LinearSolid(const ToolGeometry& geometry) {
    tool.geometry = geometry;
    tool.tip = {4e-4, 3e-4, 0};
  }

  void press(double depth) {
    Tool pressed = tool;
    pressed.tip += depth * tool.inward;
    contact.move_to(pressed);
  }

  /// Around all that the tool will meet.
  ContactPatch patch() {
    press(0.003);
    return {contact, model, rest};
  }

  Displacement moved(const ContactPatch& patch, const Eigen::VectorXd& d) const {
    Displacement u = rest;
    for (int node = 0; node < model.mesh().nodes(); ++node)
      for (Eigen::Index i = 0; i < d.size(); i += 3)
        if (patch.unknowns()[to_index(static_cast<int>(i))] == model.equation(node))
          u.col(node) = d.segment<3>(i);
    return u;
  }
};

Eigen::MatrixXd coupled_springs(Eigen::Index n) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd G = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
  return 20 * Eigen::MatrixXd::Identity(n, n) + 10 * G * G.transpose() / static_cast<double>(n);
}

/// Springs all over the face, a tenth as stiff as the contact, and weak ones along it.
Eigen::MatrixXd bedding(LinearSolid& solid, ContactPatch& patch) {
  solid.press(0.001);
  patch.start_from(solid.contact, solid.rest);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(patch.size(), patch.size());
  patch.add_hessian(solid.contact, Eigen::VectorXd::Zero(patch.size()), true, H);
  const Eigen::MatrixXd whole = H.selfadjointView<Eigen::Lower>();
  return 0.1 * whole + 1e-3 * Eigen::MatrixXd::Identity(patch.size(), patch.size());
}

struct Step {
  double work, stored, force, depth;
};

/// From `from` to `to` in one increment, the second equilibrium found with S, the work with `seen`.
Step one_step(LinearSolid& solid, double from, double to, double seen = 1) {
  ContactPatch patch = solid.patch();
  const bool disc = solid.tool.geometry.shape == ToolShape::Disc;
  const Eigen::MatrixXd S = disc ? bedding(solid, patch) : coupled_springs(patch.size());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(patch.size());
  const auto equilibrium = [&](double depth) {
    solid.press(depth);
    patch.start_from(solid.contact, solid.rest);
    const PatchStiffness stiffness{S, zero};
    PatchSolver solver;
    solver.use(stiffness);
    return solver.minimum(patch, solid.contact, zero, zero, 1e-12).value();
  };
  const auto stored = [&](const Eigen::VectorXd& d) {
    return 0.5 * d.dot(S * d) + patch.energy(solid.contact, d);
  };
  const Eigen::VectorXd first = equilibrium(from);
  const Eigen::Vector3d tip = solid.contact.tool().tip;
  const double before = stored(first);
  const Eigen::VectorXd last = equilibrium(to);
  Step step{0, stored(last) - before, patch.tool_force(solid.contact, last).dot(solid.tool.inward),
            to - from};
  const auto work = work_between(patch, {seen * S, zero}, solid.contact, tip,
                                 solid.moved(patch, first), solid.moved(patch, last));
  EXPECT_TRUE(work.has_value());
  step.work = work.value_or(0);
  return step;
}

TEST(IncrementWork, OfADiscOnALinearSolidIsHalfTheForceTimesTheDepth) {
  LinearSolid solid({ToolShape::Disc, kRadius, 0, 0});
  const Step step = one_step(solid, 0, 0.001);
  EXPECT_NEAR(step.work, 0.5 * step.force * step.depth, 1e-6 * step.work);
}

/// The contact grows from nothing over several facets: no power law, no parabola.
TEST(IncrementWork, OfASphereOnALinearSolidIsTheStoredEnergy) {
  LinearSolid solid({ToolShape::Sphere, kRadius, 0, 0});
  for (const double depth : {0.0003, 0.001, 0.002}) {
    const Step step = one_step(solid, 0, depth);
    EXPECT_NEAR(step.work, step.stored, 2e-3 * step.stored) << depth;
  }
  const Step later = one_step(solid, 0.0005, 0.002);
  EXPECT_NEAR(later.work, later.stored, 1e-3 * later.stored);
}

TEST(IncrementWork, WithAnotherStiffnessIsCorrectedByTheForcesAtBothEnds) {
  LinearSolid solid({ToolShape::Sphere, kRadius, 0, 0});
  for (const double seen : {0.7, 1.5}) {
    const Step step = one_step(solid, 0, 0.001, seen);
    EXPECT_NEAR(step.work, step.stored, 0.02 * step.stored);
  }
  LinearSolid disc({ToolShape::Disc, kRadius, 0, 0});
  const Step step = one_step(disc, 0, 0.001, 1.5);
  EXPECT_NEAR(step.work, step.stored, 1e-6 * step.stored);
}

TEST(IncrementWork, IsEmptyWhereThePatchDoesNotCoverTheContact) {
  LinearSolid solid({ToolShape::Sphere, kRadius, 0, 0});
  solid.press(1e-5);
  ContactPatch small(solid.contact, solid.model, solid.rest);
  const Eigen::Vector3d tip = solid.contact.tool().tip;
  const Eigen::MatrixXd S = coupled_springs(small.size());
  solid.press(0.004);
  EXPECT_FALSE(work_between(small, {S, Eigen::VectorXd::Zero(S.rows())}, solid.contact, tip,
                            solid.rest, solid.rest));
}

}  // namespace
}  // namespace palpate::fem
