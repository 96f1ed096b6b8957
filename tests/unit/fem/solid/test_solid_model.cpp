// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/solid_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fem/factor/cholesky.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

class SolidModels : public testing::TestWithParam<Dilatation> {
 protected:
  Body body =
      test::make_block(test::even(0, 0.02, 3), test::even(0, 0.02, 3), test::even(0, 0.02, 3));
  Gravity gravity{{1, 2, -9.81}, 1000};
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.45, "t")}, GetParam(), gravity};
  Eigen::VectorXd d = 1e-4 * Eigen::VectorXd::Random(model.pattern().n),
                  e = 1e-4 * Eigen::VectorXd::Random(model.pattern().n);
  Displacement moved(double s) const {
    Displacement u = Displacement::Zero(3, model.mesh().nodes());
    add_step(model, 1, d, u);
    add_step(model, s, e, u);
    return u;
  }
};

/// Central differences of the energy and the forces along a direction.
TEST_P(SolidModels, HaveForcesAndStiffnessOfTheirEnergy) {
  constexpr double h = 1e-3;
  Eigen::VectorXd f, high, low;
  const double up = model.forces(moved(h), high).energy, down = model.forces(moved(-h), low).energy;
  model.forces(moved(0), f);
  EXPECT_NEAR(f.dot(e), (up - down) / (2 * h), 1e-5 * f.norm() * e.norm());
  std::vector<double> K;
  model.stiffness(moved(0), K);
  Eigen::VectorXd Ke(e.size());
  symmetric_multiply(model.pattern(), K, e.data(), Ke.data());
  EXPECT_LT((Ke - (high - low) / (2 * h)).norm(), 1e-5 * Ke.norm());
  EXPECT_DOUBLE_EQ(model.energy(moved(0)).energy, model.forces(moved(0), f).energy);
}

/// Frame indifference: the stiffness of a body that is strained by F and then rotated by R is that
/// of the body at rest between rotations, whatever the stretch was.
TEST_P(SolidModels, HaveTheStiffnessAtRestTurnedWithTheBody) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Eigen::Matrix3d stretch = Eigen::Vector3d(1.4, 0.9, 0.7).asDiagonal();
  const auto times = [&](const std::vector<double>& K, const Eigen::VectorXd& x) {
    Eigen::VectorXd product(x.size());
    symmetric_multiply(model.pattern(), K, x.data(), product.data());
    return product;
  };
  std::vector<double> at_rest, turned;
  model.stiffness(Displacement::Zero(3, model.mesh().nodes()), at_rest);
  model.turned_stiffness((R * stretch - Eigen::Matrix3d::Identity()) * model.mesh().X, turned);
  const Eigen::VectorXd product = times(turned, d);
  const Eigen::Matrix3Xd back =
      R.transpose() * Eigen::Map<Eigen::Matrix3Xd>(d.data(), 3, d.size() / 3);
  Eigen::VectorXd rotated =
      times(at_rest, Eigen::Map<const Eigen::VectorXd>(back.data(), d.size()));
  Eigen::Map<Eigen::Matrix3Xd> nodes(rotated.data(), 3, d.size() / 3);
  nodes = (R * nodes).eval();
  EXPECT_LT((product - rotated).norm(), 1e-9 * product.norm());
}

/// A bent body with an element turned inside out.
TEST_P(SolidModels, StayPositiveDefiniteTurnedByElements) {
  const Eigen::Matrix3Xd& X = model.mesh().X;
  Displacement u = Displacement::Zero(3, X.cols());
  for (Eigen::Index node = 0; node < X.cols(); ++node) {
    const double angle = 60 * X(2, node), r = 1 / 60.0 - X(0, node);  // rad, m
    u.col(node) << 1 / 60.0 - r * std::cos(angle) - X(0, node), 0, r * std::sin(angle) - X(2, node);
  }
  const auto& first = model.mesh().tetrahedra[0];
  for (std::size_t c = 0; c < 4; ++c)
    u.col(first[c]) += Eigen::Vector3d(0.01 * double(c % 2), 0, 0);
  ASSERT_LT(model.energy(u).min_J, 0.0);
  std::vector<double> K;
  model.turned_stiffness(u, K);
  EXPECT_TRUE(Cholesky(model.pattern()).factorize(K));
}

TEST_P(SolidModels, CarryTheWeightOfTheirVolume) {
  double weight = 0;
  for (int i = 2; i < model.weight().size(); i += 3) weight += model.weight()[i];
  EXPECT_LT(weight, 0);
  EXPECT_GT(weight, -9810 * 8e-6);  // without the part on the fixed base
  EXPECT_GT(model.weight_norm(), 0);
}

/// An affine map multiplies every volume by its determinant.
TEST_P(SolidModels, HaveTheVolumeOfTheDisplacedBody) {
  Eigen::Matrix3d F;
  F << 1.1, 0.05, 0, -0.02, 0.95, 0.1, 0.03, 0, 0.9;
  const Displacement u = (F - Eigen::Matrix3d::Identity()) * model.mesh().X;
  EXPECT_NEAR(model.energy(Displacement::Zero(3, model.mesh().nodes())).volume, 8e-6, 1e-18);
  EXPECT_NEAR(model.energy(u).volume, F.determinant() * 8e-6, 1e-17);
}

/// The pressures at the end of a straight step, to first order in it: by central differences. Those
/// at both ends are mean stresses, as the isochoric stress has none.
TEST_P(SolidModels, ForetellThePressuresOfAStep) {
  const Displacement from = moved(0), to = moved(1);
  const std::vector<double> foretold = model.foretold_pressures(from, to);
  if (GetParam() != Dilatation::Mean) {
    EXPECT_TRUE(foretold.empty());
    return;
  }
  constexpr double h = 1e-3;
  std::vector<double> density, start, before, after;
  model.element_fields(from, density, start);
  model.element_fields(from + h * (to - from), density, after);
  model.element_fields(from - h * (to - from), density, before);
  ASSERT_EQ(foretold.size(), start.size());
  double largest = 0;
  for (std::size_t e = 0; e < start.size(); ++e)
    largest = std::max(largest, std::abs(foretold[e] - start[e]));
  for (std::size_t e = 0; e < start.size(); ++e)
    EXPECT_NEAR(foretold[e], start[e] + (after[e] - before[e]) / (2 * h), 1e-5 * largest);
}

TEST_P(SolidModels, FindTheMostCompressedElement) {
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  for (int node = 0; node < model.mesh().nodes(); ++node) {
    const double z = model.mesh().X(2, node) / 0.02;
    u(2, node) = -0.3 * 0.02 * z * z * z;  // compresses the top most
  }
  straighten(model.mesh(), u);
  const SolidModel::Compressed worst = model.most_compressed(u);
  EXPECT_DOUBLE_EQ(worst.J, model.energy(u).min_J);
  EXPECT_GT(worst.X[2], 0.013);
}

INSTANTIATE_TEST_SUITE_P(Elements, SolidModels,
                         testing::Values(Dilatation::Mean, Dilatation::Nodal, Dilatation::Pointwise,
                                         Dilatation::LinearNodal),
                         [](const auto& instance) {
                           return std::to_string(static_cast<int>(instance.param));
                         });

/// A stiffness with given pressures is the stiffness where they are those of the displacement, and
/// is linear in them.
TEST(SolidModel, HasAStiffnessLinearInThePressuresOfItsElements) {
  const Body body =
      test::make_block(test::even(0, 0.02, 3), test::even(0, 0.02, 3), test::even(0, 0.02, 3));
  const SolidModel model(body, {NeoHookean::from_young_poisson(10e3, 0.45, "t")});
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  add_step(model, 1, 1e-4 * Eigen::VectorXd::Random(model.pattern().n), u);
  std::vector<double> density, p, K, with, without, with_twice;
  model.element_fields(u, density, p);
  model.stiffness(u, K);
  model.stiffness(u, with, nullptr, p);
  model.stiffness(u, without, nullptr, std::vector<double>(p.size(), 0.0));
  for (double& pressure : p) pressure *= 2;
  model.stiffness(u, with_twice, nullptr, p);
  const double largest = *std::max_element(K.begin(), K.end());
  double part = 0;
  for (std::size_t i = 0; i < K.size(); ++i) {
    EXPECT_NEAR(with[i], K[i], 1e-9 * largest);
    EXPECT_NEAR(with_twice[i] - without[i], 2 * (with[i] - without[i]), 1e-9 * largest);
    part = std::max(part, std::abs(with[i] - without[i]));
  }
  EXPECT_GT(part, 1e-6 * largest);
}

TEST(SolidModel, WindowHasTheForcesOfTheWholeOnItsUnknowns) {
  const Body body =
      test::make_block(test::even(0, 0.02, 4), test::even(0, 0.02, 4), test::even(0, 0.02, 4));
  const SolidModel whole(body, {NeoHookean::from_young_poisson(10e3, 0.45, "t")});
  const SolidModel window(whole, Eigen::Vector3d(0.01, 0.01, 0.02), 0.008);
  Displacement u = Displacement::Zero(3, whole.mesh().nodes());
  add_step(whole, 1e-4, Eigen::VectorXd::Random(whole.pattern().n), u);
  Eigen::VectorXd all, part;
  whole.forces(u, all);
  window.forces(u, part);
  ASSERT_GT(part.size(), 0);
  ASSERT_LT(part.size(), all.size());
  for (int node = 0; node < whole.mesh().nodes(); ++node)
    if (window.equation(node) >= 0) {
      EXPECT_LT(
          (part.segment<3>(window.equation(node)) - all.segment<3>(whole.equation(node))).norm(),
          1e-13);
    }
}

}  // namespace
}  // namespace palpate::fem
