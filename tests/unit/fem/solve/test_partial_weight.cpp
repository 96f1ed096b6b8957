// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/partial_weight.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/laws/law_table.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/heavy_rod.hpp"

namespace palpate::fem {
namespace {

constexpr double kRadius = 0.004, kLength = 0.2, kDensity = 1000, kGravity = 9.81;

/// A level rod whose sag is `sag` of its length, were it small.
struct LevelRod {
  explicit LevelRod(double sag)
      : young(kDensity * kGravity * std::pow(kLength, 3) / (2 * sag * std::pow(kRadius, 2))),
        model(test::make_rod(kRadius, kLength, 40), {make_law({young, 0.3}, "t")}, Dilatation::Mean,
              Gravity{{0, -kGravity, 0}, kDensity}),
        permutation(nested_dissection(model.pattern())) {}

  double young;
  SolidModel model;
  std::vector<int> permutation;
};

/// The rounding of the displacements is a force of more than 1e-9 of the weight: a residual below
/// that is never met, and the equilibrium is found all the same.
TEST(PartialWeight, StopsAtTheRoundingErrorOfASlenderBody) {
  const LevelRod rod(0.02);
  PartialWeight body(rod.model, rod.permutation);
  Displacement u = Displacement::Zero(3, rod.model.mesh().nodes());
  ASSERT_EQ(body.equilibrate(1, u), PartialWeight::Outcome::Found);
  EXPECT_LE(body.iterations(), 6);
  Eigen::VectorXd residual;
  rod.model.forces(u, residual);
  const double weight = rod.model.weight().norm();
  EXPECT_LT(residual.norm(), 1e-6 * weight);
  EXPECT_GT(residual.norm(), 1e-9 * weight);
  // q L^4/(8 E I) = 2 % of the length.
  EXPECT_NEAR(u(1, 40 * 19), -0.02 * kLength, 0.01 * 0.02 * kLength);
}

/// Newton's first step would move the tip by more than the length of the rod.
TEST(PartialWeight, TurnsARodByALargeAngleAtOnce) {
  const LevelRod rod(1.2);
  PartialWeight body(rod.model, rod.permutation);
  Displacement u = Displacement::Zero(3, rod.model.mesh().nodes());
  ASSERT_EQ(body.equilibrate(1, u), PartialWeight::Outcome::Found);
  EXPECT_GT(body.first_step(), kLength);
  EXPECT_LE(body.iterations(), 40);
}

/// Part of the weight is a smaller gravity.
TEST(PartialWeight, IsThatOfASmallerGravity) {
  const Body block =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, 0.02, 2));
  const auto loaded = [&](double part, double gravity) {
    const SolidModel model(block, {make_law({3e3, 0.45}, "t")}, Dilatation::Mean,
                           Gravity{{1, 0, -gravity}, kDensity});
    const std::vector<int> permutation = nested_dissection(model.pattern());
    Displacement u = Displacement::Zero(3, model.mesh().nodes());
    EXPECT_EQ(PartialWeight(model, permutation).equilibrate(part, u),
              PartialWeight::Outcome::Found);
    return u;
  };
  SolidModel half(block, {make_law({3e3, 0.45}, "t")}, Dilatation::Mean,
                  Gravity{{0.5, 0, -5}, kDensity});
  const Displacement u = loaded(0.5, 10);
  Eigen::VectorXd residual;
  half.forces(u, residual);
  EXPECT_LT(residual.norm(), 2e-9 * half.weight().norm());
  EXPECT_GT(u.norm(), 1e-4);
}

/// A long step leaves large pressures: the stiffness there is not positive definite, though the
/// equilibrium is stable. It is that to which small parts of the weight lead.
TEST(PartialWeight, PassesStatesOfLargePressures) {
  const SolidModel model(
      test::make_block(test::even(0, 0.02, 3), test::even(0, 0.02, 3), test::even(0, 0.06, 9)),
      {make_law({2.5e3, 0.495}, "t")}, Dilatation::Mean, Gravity{{9.81, 0, 0}, kDensity});
  const std::vector<int> permutation = nested_dissection(model.pattern());
  PartialWeight body(model, permutation);
  const Displacement rest = Displacement::Zero(3, model.mesh().nodes());
  Displacement at_once = rest, in_parts = rest;
  ASSERT_EQ(body.equilibrate(0.08, at_once), PartialWeight::Outcome::Found);
  EXPECT_LE(body.iterations(), 8);  // 17 where such a step is taken back
  EXPECT_TRUE(body.weakest_mode(at_once));
  for (int i = 1; i <= 8; ++i)
    ASSERT_EQ(body.equilibrate(0.01 * i, in_parts), PartialWeight::Outcome::Found) << i;
  EXPECT_LT((at_once - in_parts).norm(), 1e-6 * in_parts.norm());
}

/// The factor of the first step is in the resident memory when the second begins: what it needs is
/// not asked for twice.
TEST(PartialWeight, TakesItsMemoryOnce) {
  const Body block =
      test::make_block(test::even(0, 0.05, 9), test::even(0, 0.05, 9), test::even(0, 0.05, 9));
  const SolidModel model(block, {make_law({3e3, 0.45}, "t")}, Dilatation::Mean,
                         Gravity{{1, 0, -9.81}, kDensity});
  const std::vector<int> permutation = nested_dissection(model.pattern());
  const double factor =
      PartialFactor(model.pattern(), &permutation, {}).bytes(Precision::Single, 1);
  const double matrix = sizeof(double) * static_cast<double>(model.pattern().nonzeros());
  ASSERT_GT(factor, 2 * matrix);
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  PartialWeight body(model, permutation, {resident_bytes() + 1.2 * factor + matrix, 1});
  ASSERT_EQ(body.equilibrate(1, u), PartialWeight::Outcome::Found);
  EXPECT_GT(body.iterations(), 2);
}

/// The weakest mode of a rod is its bending, and tension stiffens it.
TEST(PartialWeight, FindsTheWeakestMode) {
  const LevelRod rod(0.5);
  PartialWeight body(rod.model, rod.permutation);
  Displacement u = Displacement::Zero(3, rod.model.mesh().nodes());
  const auto rest = body.weakest_mode(u);
  ASSERT_TRUE(rest);
  EXPECT_NEAR(rest->X[2], kLength, 1e-9);
  for (int node = 0; node < rod.model.mesh().nodes(); ++node)
    u(2, node) = 0.01 * rod.model.mesh().X(2, node);
  const auto stretched = body.weakest_mode(u);
  ASSERT_TRUE(stretched);
  EXPECT_GT(stretched->stiffness, 1.5 * rest->stiffness);
  for (int node = 0; node < rod.model.mesh().nodes(); ++node)
    u(2, node) = -0.01 * rod.model.mesh().X(2, node);
  EXPECT_FALSE(body.weakest_mode(u));
}

}  // namespace
}  // namespace palpate::fem
