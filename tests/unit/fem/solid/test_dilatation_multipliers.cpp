// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies of which a part is nearly incompressible, under uniform dilatation.
#include "fem/solid/dilatation_multipliers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/solid/solid_model.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kYoung = 10e3;  // Pa

Law tissue(double poisson) {
  return NeoHookean::from_young_poisson(kYoung, poisson, "t");
}

TEST(DilatationMultipliers, BelongToNearlyIncompressibleRegions) {
  const DilatationMultipliers both({tissue(0.49), tissue(0.4999)}, 7);
  EXPECT_TRUE(both.any());
  EXPECT_FALSE(both.relax(0));
  EXPECT_TRUE(both.relax(1));
  EXPECT_EQ(both.values, std::vector<double>(7, 0.0));
  const DilatationMultipliers none({tissue(0.45), tissue(0.49)}, 7);
  EXPECT_FALSE(none.any());
  EXPECT_FALSE(none.relax(1));
  EXPECT_FALSE(DilatationMultipliers().any());
}

/// The penalty follows the shear modulus, and is far below the bulk modulus.
TEST(DilatationMultipliers, SoftenTheVolumeToThatOfAModerateSolid) {
  const double poisson = 0.4999, mu = kYoung / (2 * (1 + poisson)),
               kappa = kYoung / (3 * (1 - 2 * poisson));
  const DilatationMultipliers multipliers({tissue(poisson)}, kLanes);
  const Law law = tissue(poisson);
  const double slope = multipliers.augmented(law, 0, {}).pressure_slope(Lanes::Constant(1))[0];
  const double moderate = 2 * mu * 1.49 / (3 * 0.02);  // kappa of Poisson's ratio 0.49
  EXPECT_NEAR(slope, 1 / (1 / kappa + 1 / moderate), 1e-9 * slope);
}

class DilatedBlock : public testing::TestWithParam<Dilatation> {
 protected:
  Body body =
      test::make_block(test::even(0, 0.01, 2), test::even(0, 0.01, 2), test::even(0, 0.01, 2));
  SolidModel model{body, {tissue(0.4999)}, GetParam()};
  const double stretch = 1.0003, J = stretch * stretch * stretch;
  Displacement u = (stretch - 1) * model.mesh().X;
  DilatationMultipliers multipliers = model.multipliers();
};

TEST_P(DilatedBlock, HasThePressureOfItsDilatation) {
  model.take_pressures(u, multipliers);
  const double kappa = kYoung / (3 * (1 - 2 * 0.4999));
  ASSERT_EQ(multipliers.values.size(),
            GetParam() == Dilatation::Mean ? model.mesh().tetrahedra.size() : body.nodes.size());
  for (const double p : multipliers.values) EXPECT_NEAR(p, kappa / 2 * (J - 1 / J), 1e-9 * kappa);
  const std::vector<double> before = multipliers.values;
  model.update(u, multipliers);
  for (std::size_t e = 0; e < before.size(); ++e)
    EXPECT_NEAR(multipliers.values[e], before[e], 1e-9 * before[e]);
}

TEST_P(DilatedBlock, HasTheEnergyAndTheForcesOfItsLawAtThePressures) {
  model.take_pressures(u, multipliers);
  Eigen::VectorXd exact, relaxed;
  const SolidModel::State law = model.forces(u, exact);
  const SolidModel::State with = model.forces(u, relaxed, &multipliers);
  EXPECT_NEAR(with.energy, law.energy, 1e-9 * law.energy);
  EXPECT_NEAR(model.energy(u, &multipliers).energy, law.energy, 1e-9 * law.energy);
  EXPECT_LT((relaxed - exact).norm(), 1e-9 * exact.norm());
}

/// Forces and stiffness with any multipliers are derivatives of the energy with these.
TEST_P(DilatedBlock, HasDerivativesOfTheRelaxedEnergy) {
  for (std::size_t e = 0; e < multipliers.values.size(); ++e)
    multipliers.values[e] = 100.0 * static_cast<double>(e) - 3e3;
  Eigen::VectorXd f, low, high;
  model.forces(u, f, &multipliers);
  std::vector<double> K;
  model.stiffness(u, K, &multipliers);
  Eigen::VectorXd d(f.size());
  for (Eigen::Index i = 0; i < d.size(); ++i) d[i] = std::sin(1.7 * static_cast<double>(i) + 0.3);
  const double h = 1e-7;
  Displacement minus = u, plus = u;
  add_step(model, -h, d, minus);
  add_step(model, h, d, plus);
  const double slope = (model.forces(plus, high, &multipliers).energy -
                        model.forces(minus, low, &multipliers).energy) /
                       (2 * h);
  EXPECT_NEAR(f.dot(d), slope, 1e-6 * f.norm() * d.norm());
  Eigen::VectorXd Kd(f.size());
  symmetric_multiply(model.pattern(), K, d.data(), Kd.data());
  const Eigen::VectorXd difference = (high - low) / (2 * h);
  EXPECT_LT((Kd - difference).norm(), 1e-5 * Kd.norm());
}

INSTANTIATE_TEST_SUITE_P(Elements, DilatedBlock,
                         testing::Values(Dilatation::Mean, Dilatation::Nodal));

TEST(DilatationMultipliersOfAModel, AreThoseOfItsPressures) {
  const Body body =
      test::make_block(test::even(0, 0.01, 1), test::even(0, 0.01, 1), test::even(0, 0.01, 1));
  EXPECT_TRUE(SolidModel(body, {tissue(0.4999)}, Dilatation::Nodal).multipliers().any());
  EXPECT_FALSE(SolidModel(body, {tissue(0.49)}, Dilatation::Nodal).multipliers().any());
  EXPECT_FALSE(SolidModel(body, {tissue(0.4999)}, Dilatation::LinearNodal).multipliers().any());
  EXPECT_FALSE(SolidModel(body, {tissue(0.4999)}, Dilatation::Pointwise).multipliers().any());
  EXPECT_TRUE(SolidModel(body, {tissue(0.4999)}).multipliers().any());
}

}  // namespace
}  // namespace palpate::fem
