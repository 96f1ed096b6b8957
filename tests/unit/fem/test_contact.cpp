// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "fem/at.hpp"
#include "fem/contact.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// A sphere of 5 mm pressed 1 mm into the middle of the top of an undeformed block, so that some
/// points are in contact and some are not.
struct Pressed {
  Body body = test::make_block(test::even(-0.01, 0.01, 4), test::even(-0.01, 0.01, 4),
                               test::even(-0.02, 0, 3));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")}};
  SphereContact contact{model.mesh(), Eigen::Vector3d::Zero(), 0.01, 1e8};
  Displacement u = Displacement::Zero(3, model.mesh().nodes());

  Pressed() { contact.move_to({Eigen::Vector3d(2e-4, 1e-4, 0.004), 0.005}); }
};

/// Forces and stiffness of the contact against central differences of its energy.
void expect_derivatives(const SolidModel& model, const SphereContact& contact, Displacement u) {
  const int n = model.pattern().n;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
  contact.add_forces(model, u, f);
  std::vector<double> K(at(model.pattern().nonzeros()), 0.0);
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

TEST(SphereContact, ForcesAndStiffnessAreDerivativesOfTheEnergy) {
  const Pressed p;
  expect_derivatives(p.model, p.contact, p.u);
}

TEST(SphereContact, StuckForcesAndStiffnessAreDerivativesOfTheEnergy) {
  Pressed p;
  p.contact.bond(p.u);
  p.contact.move_to({Eigen::Vector3d(5e-4, 1e-4, 0.004), 0.005});
  expect_derivatives(p.model, p.contact, p.u);
}

TEST(SphereContact, BondingLeavesTheForceAsItWas) {
  Pressed p;
  const Eigen::Vector3d before = p.contact.tool_force(p.u);
  ASSERT_GT(before.norm(), 0.01);
  p.contact.bond(p.u);
  EXPECT_LT((p.contact.tool_force(p.u) - before).norm(), 1e-12 * before.norm());
}

TEST(SphereContact, ToolForceBalancesTheForcesOnTheNodes) {
  const Pressed p;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(p.model.pattern().n);
  p.contact.add_forces(p.model, p.u, f);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < f.size(); i += 3) sum -= f.segment<3>(i);
  EXPECT_LT((sum - p.contact.tool_force(p.u)).norm(), 1e-12);
  EXPECT_LT(p.contact.tool_force(p.u)[2], 0);  // the tool pushes the body down
}

TEST(SphereContact, RestPenetrationIsTheDepthOfTheSphere) {
  const Pressed p;
  const double depth = p.contact.rest_penetration({Eigen::Vector3d(0, 0, 0.004), 0.005});
  EXPECT_LE(depth, 1e-3);
  EXPECT_GT(depth, 0.9e-3);  // the deepest quadrature point lies near, not at, the pole
  EXPECT_LE(p.contact.rest_penetration({Eigen::Vector3d(0, 0, 0.0051), 0.005}), 0);
}

}  // namespace
}  // namespace palpate::fem
