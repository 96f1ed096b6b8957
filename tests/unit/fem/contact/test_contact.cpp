// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/contact.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "format/to_index.hpp"
#include "tests/unit/fem/contact/pressed_block.hpp"

namespace palpate::fem {
namespace {

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

TEST(ToolContact, BondedForcesAndStiffnessAreDerivativesOfTheEnergy) {
  Pressed p;
  p.contact.bond(p.u);
  p.contact.move_to(sphere(Eigen::Vector3d(5e-4, 1e-4, 0.004)));
  expect_derivatives(p.model, p.contact, p.u);
}

TEST(ToolContact, HasForcesAndStiffnessOfItsEnergyForEveryTool) {
  for (const ToolGeometry& tool : {ToolGeometry{ToolShape::Disc, 0.005, 0.001, 0},
                                   ToolGeometry{ToolShape::Cylinder, 0.004, 0, 0.005}}) {
    Pressed p;
    const Eigen::Vector3d inward = Eigen::Vector3d(0.1, 0.05, -1).normalized();
    p.contact.move_to({tool, Eigen::Vector3d(2e-4, 1e-4, -5e-4), inward, inward.unitOrthogonal()});
    expect_derivatives(p.model, p.contact, p.u);
  }
}

TEST(ToolContact, BondedPointsResistTension) {
  Pressed p;
  EXPECT_EQ(p.contact.tension(p.u), 0);
  p.contact.bond(p.u);
  EXPECT_EQ(p.contact.tension(p.u), 0);  // compressed everywhere
  p.contact.move_to(sphere(Eigen::Vector3d(2e-4, 1e-4, 0.006)));
  EXPECT_GT(p.contact.tension(p.u), 1);
  EXPECT_GT(p.contact.tool_force(p.u)[2], 0);
}

TEST(ToolContact, BondingChangesNeitherForceNorEnergy) {
  Pressed p;
  const Eigen::Vector3d before = p.contact.tool_force(p.u);
  const double energy = p.contact.energy(p.u);
  ASSERT_GT(before.norm(), 0.01);
  p.contact.bond(p.u);
  EXPECT_NEAR(p.contact.energy(p.u), energy, 1e-12 * energy);
  EXPECT_LT((p.contact.tool_force(p.u) - before).norm(), 1e-12 * before.norm());
}

/// A sphere that is moved into a surface while this moves along it touches the circle of radius r
/// at (r/a)^2 of the increment, with a that of the end: a tie pulls back by what is left of the
/// motion.
TEST(ToolContact, BondedSinceTheStartPullsBackToWhereItTouched) {
  const Body body = test::make_block(test::even(-0.006, 0.006, 24), test::even(-0.006, 0.006, 24),
                                     test::even(-0.006, 0, 2));
  const SolidModel model(body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")});
  constexpr double kRadius = 0.005, kDepth = 0.001, kAside = 2e-4;
  ToolContact contact(model.mesh(), Eigen::Vector3d::Zero(), 0.01, {1e8, 1e4});
  const IncrementStart start{Displacement::Zero(3, model.mesh().nodes()), Eigen::Vector3d::Zero()};
  Displacement u = start.u;
  u.row(0).setConstant(kAside);
  const Eigen::Vector3d tip(kAside, 0, -kDepth);  // centred on the surface as it is at the end
  contact.move_to({{ToolShape::Sphere, kRadius, 0, 0}, tip});
  ToolContact slack = contact;
  slack.bond(u);
  contact.bond_since(start, u);
  ASSERT_EQ(contact.ties().size(), slack.ties().size());
  const double touched = 2 * kRadius * kDepth - kDepth * kDepth;  // a^2
  const Eigen::Vector3d centre = tip + kRadius * Eigen::Vector3d::UnitZ();
  double farthest = 0;
  for (std::size_t i = 0; i < contact.ties().size(); ++i) {
    const ToolContact::Tie& tie = contact.ties()[i];
    EXPECT_EQ(tie.stiffness, slack.ties()[i].stiffness);
    const Eigen::Vector3d x = contact.position(tie, u);
    const double r2 = (x - tip).head<2>().squaredNorm();
    if (r2 > 0.8 * touched) continue;  // around nodes at the border less than their area touches
    const Eigen::Vector3d n = (centre - x).normalized();
    const Eigen::Vector3d motion(0, 0, kDepth);  // relative to the tool
    const Eigen::Vector3d expected = (1 - r2 / touched) * (motion - motion.dot(n) * n);
    const Eigen::Vector3d pulled = slack.ties()[i].arm - tie.arm;
    EXPECT_LT((pulled - expected).norm(), 0.05 * kDepth) << x.transpose();
    farthest = std::max(farthest, expected.norm());
  }
  EXPECT_GT(farthest, 0.1 * kDepth);
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

/// The surface at this node, pressed 1 mm towards the middle of the body.
struct PressedAt : Pressed {
  explicit PressedAt(int node) {
    const Eigen::Vector3d X = model.mesh().X.col(node);
    const Eigen::Vector3d inward = (Eigen::Vector3d(0, 0, -0.01) - X).normalized();
    contact = ToolContact(model.mesh(), X, 0.01, {1e8, 1e4});
    contact.move_to({{}, X + 0.001 * inward, inward, inward.unitOrthogonal()});
  }
};

int node_of_first_equation(const SolidModel& model) {
  int node = 0;
  while (model.equation(node) != 0) ++node;
  return node;
}

/// Values at a little more and a little less of one displacement, over twice that little.
template <class Value>
auto derivative(Displacement& u, int i, int node, const Value& value) {
  constexpr double h = 1e-8;
  const double at = u(i, node);
  u(i, node) = at + h;
  const auto high = value();
  u(i, node) = at - h;
  const auto low = value();
  u(i, node) = at;
  return ((high - low) / (2 * h)).eval();
}

TEST(ToolContact, TheFirstUnknownIsOneLikeOthers) {
  const Eigen::Vector3d direction(0.3, -0.5, 0.8);
  const int node = node_of_first_equation(Pressed().model);
  for (const bool bonded : {false, true}) {
    PressedAt p(node);
    if (bonded) p.contact.bond(p.u);
    const int n = p.model.pattern().n;
    Eigen::VectorXd g = Eigen::VectorXd::Zero(n), unit = g, column = g;
    p.contact.add_tool_force_gradient(p.model, p.u, direction, g);
    std::vector<double> K(to_index(p.model.pattern().nonzeros()), 0.0);
    p.contact.add_stiffness(p.model, p.u, true, K);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d of_tool =
          derivative(p.u, i, node, [&] { return p.contact.tool_force(p.u); });
      EXPECT_GT(of_tool.norm(), 1);  // N/m
      EXPECT_NEAR(g[i], of_tool.dot(direction), 1e-5 * g.norm());
      const Eigen::VectorXd of_nodes = derivative(p.u, i, node, [&] {
        Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
        p.contact.add_forces(p.model, p.u, f);
        return f;
      });
      unit.setZero();
      unit[i] = 1;
      symmetric_multiply(p.model.pattern(), K, unit.data(), column.data());
      EXPECT_LT((column - of_nodes).norm(), 1e-5 * of_nodes.norm());
    }
  }
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
