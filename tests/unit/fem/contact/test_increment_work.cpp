// SPDX-License-Identifier: AGPL-3.0-or-later
// The work of the tool over one increment, against a closed form and against
// what must have become of it.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "fem/contact/increment_work.hpp"
#include "fem/contact/patch_solver.hpp"
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

/// From `from` to `to` in one increment.
Step one_step(LinearSolid& solid, double from, double to) {
  ContactPatch patch = solid.patch();
  const bool disc = solid.tool.geometry.shape == ToolShape::Disc;
  const Eigen::MatrixXd S = disc ? bedding(solid, patch) : coupled_springs(patch.size());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(patch.size());
  const auto equilibrium = [&](double depth) {
    solid.press(depth);
    const PatchStiffness stiffness{S, zero};
    PatchSolver solver;
    solver.use(stiffness);
    Eigen::VectorXd d = zero;
    for (int i = 0; i < 3; ++i) {  // what rounding leaves of one step is left to the next
      patch.start_from(solid.contact, solid.moved(patch, d));
      d += solver.minimum(patch, solid.contact, -S * d, zero, 1e-12).value();
    }
    patch.start_from(solid.contact, solid.rest);
    return d;
  };
  const auto stored = [&](const Eigen::VectorXd& d) {
    return 0.5 * d.dot(S * d) + patch.energy(solid.contact, d);
  };
  const Eigen::VectorXd first = equilibrium(from);
  const Eigen::Vector3d tip = solid.contact.tool().tip;
  const double before = stored(first);
  const Eigen::VectorXd last = equilibrium(to);
  const Displacement u = solid.moved(patch, last);
  Step step{0, stored(last) - before, solid.contact.tool_force(u).dot(solid.tool.inward),
            to - from};
  const auto work = work_between(solid.contact, solid.model, tip, solid.moved(patch, first), u);
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
    EXPECT_NEAR(step.work, step.stored, 1e-8 * step.stored) << depth;
  }
  const Step later = one_step(solid, 0.0005, 0.002);
  EXPECT_NEAR(later.work, later.stored, 1e-8 * later.stored);
}

/// Against the forces of the tool alone, in 64 steps by the trapezoidal rule.
TEST(IncrementWork, IsTheIntegralOfTheForceOfTheTool) {
  LinearSolid solid({ToolShape::Sphere, kRadius, 0, 0});
  constexpr double kFrom = 0.0005, kTo = 0.002;
  constexpr int kSteps = 64;
  double integral = 0, before = one_step(solid, 0, kFrom).force;
  for (int i = 1; i <= kSteps; ++i) {
    const double depth = kFrom + i * (kTo - kFrom) / kSteps;
    const double force = one_step(solid, 0, depth).force;
    integral += 0.5 * (before + force) * (kTo - kFrom) / kSteps;
    before = force;
  }
  EXPECT_NEAR(one_step(solid, kFrom, kTo).work, integral, 2e-4 * integral);
}

/// The surface has moved in while the force on it has fallen.
TEST(IncrementWork, IsUnknownWhereTheSolidHasSnapped) {
  LinearSolid solid({ToolShape::Sphere, kRadius, 0, 0});
  const ContactPatch patch = solid.patch();
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(patch.size());
  for (Eigen::Index i = 2; i < shift.size(); i += 3) shift[i] = -1e-4;
  solid.press(0.001);
  const Eigen::Vector3d tip = solid.contact.tool().tip;
  EXPECT_FALSE(
      work_between(solid.contact, solid.model, tip, solid.rest, solid.moved(patch, shift)));
}

}  // namespace
}  // namespace palpate::fem
