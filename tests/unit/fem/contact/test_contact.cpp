// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "fem/contact/contact_patch.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// A sphere of 5 mm above the block.
Tool sphere(const Eigen::Vector3d& centre) {
  return {{}, centre - 0.005 * Eigen::Vector3d::UnitZ()};
}

/// A sphere of 5 mm pressed 1 mm into the middle of the top of an undeformed block, so that some
/// points are in contact and some are not.
struct Pressed {
  Body body = test::make_block(test::even(-0.01, 0.01, 4), test::even(-0.01, 0.01, 4),
                               test::even(-0.02, 0, 3));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")}};
  ToolContact contact{model.mesh(), Eigen::Vector3d::Zero(), 0.01, {1e8, 1e4}};
  Displacement u = Displacement::Zero(3, model.mesh().nodes());

  Pressed() { contact.move_to(sphere(Eigen::Vector3d(2e-4, 1e-4, 0.004))); }
};

/// Forces and stiffness of the contact against central differences of its energy.
void expect_derivatives(const SolidModel& model, const ToolContact& contact, Displacement u) {
  const int n = model.pattern().n;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
  contact.add_forces(model, u, f);
  std::vector<double> K(to_index(model.pattern().nonzeros()), 0.0);
  contact.add_stiffness(model, u, true, K);
  const double h = 1e-8;
  int compared = 0;
  for (int node = 0; node < model.mesh().nodes(); ++node) {
    const int first = model.equation(node);
    if (first < 0 || model.mesh().X.col(node).norm() > 0.008) continue;
    for (int i = 0; i < 3; ++i) {
      const double at = u(i, node);
      Eigen::VectorXd high = Eigen::VectorXd::Zero(n), low = high, unit = high, product(n);
      u(i, node) = at + h;
      const double energy_high = contact.energy(u);
      contact.add_forces(model, u, high);
      u(i, node) = at - h;
      const double energy_low = contact.energy(u);
      contact.add_forces(model, u, low);
      u(i, node) = at;
      EXPECT_NEAR(f[first + i], (energy_high - energy_low) / (2 * h), 1e-6 * f.norm());
      unit[first + i] = 1;
      symmetric_multiply(model.pattern(), K, unit.data(), product.data());
      EXPECT_LT((product - (high - low) / (2 * h)).norm(), 1e-4 * (product.norm() + 1));
      if (f[first + i] != 0) ++compared;
    }
  }
  EXPECT_GT(compared, 20);
}

TEST(ToolContact, ForcesAndStiffnessAreDerivativesOfTheEnergy) {
  const Pressed p;
  expect_derivatives(p.model, p.contact, p.u);
}

TEST(ToolContact, StuckForcesAndStiffnessAreDerivativesOfTheEnergy) {
  Pressed p;
  p.contact.bond(p.u);
  p.contact.move_to(sphere(Eigen::Vector3d(5e-4, 1e-4, 0.004)));
  expect_derivatives(p.model, p.contact, p.u);
}

/// The patch against the whole contact, moved by d.
TEST(ContactPatch, IsTheContactOnItsUnknowns) {
  Pressed p;
  for (const bool bonded : {false, true}) {
    if (bonded) {
      p.contact.bond(p.u);
      p.contact.move_to(sphere(Eigen::Vector3d(5e-4, 1e-4, 0.004)));
    }
    ContactPatch patch(p.contact, p.model, p.u);
    EXPECT_TRUE(patch.covers(p.contact, p.u));
    patch.start_from(p.contact, p.u);
    const auto count = static_cast<Eigen::Index>(patch.unknowns().size());
    ASSERT_GT(count, 20);
    const Eigen::VectorXd d = 2e-5 * Eigen::VectorXd::Random(count);
    Displacement moved = p.u;
    for (int node = 0; node < p.model.mesh().nodes(); ++node)
      for (Eigen::Index i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
          if (p.model.equation(node) + c == patch.unknowns()[static_cast<std::size_t>(i)] &&
              p.model.equation(node) >= 0)
            moved(c, node) += d[i];
    EXPECT_NEAR(patch.energy(p.contact, d), p.contact.energy(moved),
                1e-12 * p.contact.energy(moved));

    Eigen::VectorXd g, full = Eigen::VectorXd::Zero(p.model.pattern().n);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(count, count);
    patch.gradient(p.contact, d, g);
    patch.add_hessian(p.contact, d, true, H);
    p.contact.add_forces(p.model, moved, full);
    EXPECT_NEAR(g.norm(), full.norm(), 1e-10 * full.norm());  // no force outside the patch
    for (Eigen::Index i = 0; i < count; ++i)
      EXPECT_NEAR(g[i], full[patch.unknowns()[static_cast<std::size_t>(i)]], 1e-10 * full.norm());

    std::vector<double> K(to_index(p.model.pattern().nonzeros()), 0.0);
    p.contact.add_stiffness(p.model, moved, true, K);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) {
        if (H(i, j) == 0) continue;
        const int row = patch.unknowns()[static_cast<std::size_t>(i)];
        const int column = patch.unknowns()[static_cast<std::size_t>(j)];
        EXPECT_NEAR(H(i, j), K[to_index(p.model.pattern().position(row, column))], 1e-9 * H.norm());
      }
  }
}

TEST(ContactPatch, SaysWhenTheContactHasGrownBeyondIt) {
  const Body body = test::make_block(test::even(-0.01, 0.01, 10), test::even(-0.01, 0.01, 10),
                                     test::even(-0.004, 0, 2));
  const SolidModel model(body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")});
  ToolContact contact(model.mesh(), Eigen::Vector3d::Zero(), 0.02, {1e8, 1e4});
  const Displacement u = Displacement::Zero(3, model.mesh().nodes());
  const auto press = [&](double depth) {
    contact.move_to(sphere(Eigen::Vector3d(0, 0, 0.005 - depth)));
  };
  press(1e-4);  // a circle of 1 mm radius on facets of 2 mm
  const ContactPatch patch(contact, model, u);
  press(3e-4);
  EXPECT_TRUE(patch.covers(contact, u));
  press(4e-3);  // of 4.9 mm
  EXPECT_FALSE(patch.covers(contact, u));
}

TEST(ToolContact, EveryToolHasForcesAndStiffnessOfItsEnergy) {
  for (const ToolGeometry& tool : {ToolGeometry{ToolShape::Disc, 0.005, 0.001, 0},
                                   ToolGeometry{ToolShape::Cylinder, 0.004, 0, 0.005}}) {
    Pressed p;
    const Eigen::Vector3d inward = Eigen::Vector3d(0.1, 0.05, -1).normalized();
    p.contact.move_to({tool, Eigen::Vector3d(2e-4, 1e-4, -5e-4), inward, inward.unitOrthogonal()});
    expect_derivatives(p.model, p.contact, p.u);
  }
}

TEST(ToolContact, StuckPointsThatAreDrawnOffPull) {
  Pressed p;
  EXPECT_EQ(p.contact.tension(p.u), 0);
  p.contact.bond(p.u);
  EXPECT_EQ(p.contact.tension(p.u), 0);  // pressed all over
  p.contact.move_to(sphere(Eigen::Vector3d(2e-4, 1e-4, 0.006)));
  EXPECT_GT(p.contact.tension(p.u), 1);
  EXPECT_GT(p.contact.tool_force(p.u)[2], 0);
}

TEST(ToolContact, BondingLeavesForceAndEnergyAsTheyWere) {
  Pressed p;
  const Eigen::Vector3d before = p.contact.tool_force(p.u);
  const double energy = p.contact.energy(p.u);
  ASSERT_GT(before.norm(), 0.01);
  p.contact.bond(p.u);
  EXPECT_NEAR(p.contact.energy(p.u), energy, 1e-12 * energy);
  EXPECT_LT((p.contact.tool_force(p.u) - before).norm(), 1e-12 * before.norm());
}

TEST(ToolContact, ToolForceBalancesTheForcesOnTheNodes) {
  const Pressed p;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(p.model.pattern().n);
  p.contact.add_forces(p.model, p.u, f);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < f.size(); i += 3) sum -= f.segment<3>(i);
  EXPECT_LT((sum - p.contact.tool_force(p.u)).norm(), 1e-12);
  EXPECT_LT(p.contact.tool_force(p.u)[2], 0);  // the tool pushes the body down
}

TEST(ToolContact, PenetrationOfARestingSurfaceIsTheDepthOfTheSphere) {
  const Pressed p;
  const Displacement rest = Displacement::Zero(3, p.u.cols());
  const double depth = p.contact.penetration_of(sphere(Eigen::Vector3d(0, 0, 0.004)), rest);
  EXPECT_LE(depth, 1e-3);
  EXPECT_GT(depth, 0.9e-3);  // the deepest quadrature point lies near, not at, the pole
  EXPECT_LE(p.contact.penetration_of(sphere(Eigen::Vector3d(0, 0, 0.0051)), rest), 0);
}

}  // namespace
}  // namespace palpate::fem
