// SPDX-License-Identifier: AGPL-3.0-or-later
// Fibres: the tension switch, the dispersion, the number of families.
#include "fem/laws/holzapfel_gasser_ogden.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/fem/laws/law_samples.hpp"

namespace palpate::fem {
namespace {

constexpr double kC = 3e3, kK1 = 4e3, kK2 = 0.8;  // Pa, Pa, pure
const Fibres<double> kAlongX{{{1, 0, 0}, {0, 1, 0}}};

HolzapfelGasserOgden fibres(double dispersion, int families = 1) {
  FibreField field;
  field.families = families;
  return {{.c = kC, .k1 = kK1, .k2 = kK2, .dispersion = dispersion}, field, 0};
}

/// Isochoric extension along x.
Matrix extension(double l) {
  return Eigen::Vector3d(l, 1 / std::sqrt(l), 1 / std::sqrt(l)).asDiagonal();
}

Matrix isochoric(const Matrix& F) {
  return std::cbrt(1 / F.determinant()) * F;
}

TEST(TensionSwitch, LeavesTheMatrixAloneWhereTheFibresAreSlack) {
  const auto matrix = NeoHookean::from_moduli(kC, 0);
  std::mt19937 random(1);
  int slack = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Matrix F = isochoric(random_gradient(random));
    const auto P = isochoric_stress(fibres(0), to_tensor(F), kAlongX);
    const auto P0 = isochoric_stress(matrix, to_tensor(F));
    const double difference = (to_matrix(P) - to_matrix(P0)).norm();
    const bool shortened = F.col(0).norm() < 1;
    slack += shortened ? 1 : 0;
    if (shortened)
      EXPECT_LT(difference, 1e-12 * kC);
    else
      EXPECT_GT(difference, 1e-6 * kC);
  }
  EXPECT_GT(slack, 20);
  EXPECT_LT(slack, 180);
}

/// The second derivative of the energy of a fibre by its stretch, from the side of tension, is
/// k1 (dE/dl)^2 = 4 k1, and 0 from the other; the first is continuous.
TEST(TensionSwitch, HasAContinuousStressAndAJumpOfTheTangentByTheFibres) {
  const auto slope = [](double l) {  // dPsi/dl = P : dF/dl
    const Matrix P = to_matrix(isochoric_stress(fibres(0), to_tensor(extension(l)), kAlongX));
    const Eigen::Vector3d direction(1, -0.5 * std::pow(l, -1.5), -0.5 * std::pow(l, -1.5));
    return P.diagonal().dot(direction);
  };
  constexpr double h = 1e-6;
  EXPECT_NEAR(slope(1 + h), slope(1 - h), 20 * kK1 * h);
  const double taut = (slope(1 + h) - slope(1)) / h, slack = (slope(1) - slope(1 - h)) / h;
  EXPECT_NEAR(slack, 3 * kC, 1e-4 * kC);  // Young's modulus of the matrix
  EXPECT_NEAR(taut - slack, 4 * kK1, 1e-4 * kK1);
}

/// kappa = 1/3: E = (I1 - 3)/3, without any direction.
TEST(Dispersion, OfAThirdIsIsotropic) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix F = isochoric(random_gradient(random));
    const double I1 = F.squaredNorm(), E = (I1 - 3) / 3;
    const double expected = 0.5 * kC * (I1 - 3) + 0.5 * kK1 / kK2 * (std::exp(kK2 * E * E) - 1);
    for (const Matrix& R : {Matrix(Matrix::Identity()), random_rotation(random)}) {
      const Matrix turned = F * R;
      EXPECT_NEAR(energy(fibres(1.0 / 3), to_tensor(turned), kAlongX), expected, 1e-11 * expected);
    }
  }
}

/// A dispersed family is strained less along its direction, and more across it.
TEST(Dispersion, TakesStiffnessFromTheDirectionOfTheFibres) {
  const auto along = to_tensor(extension(1.2)), across = to_tensor(extension(1 / 1.2));
  double last_along = 1e9, last_across = 0;
  for (const double dispersion : {0.0, 0.1, 0.2, 0.3}) {
    const double a = energy(fibres(dispersion), along, kAlongX);
    const double b = energy(fibres(dispersion), across, kAlongX);
    EXPECT_LT(a, last_along);
    EXPECT_GE(b, last_across);
    last_along = a, last_across = b;
  }
}

TEST(Families, AddUp) {
  std::mt19937 random(3);
  const auto matrix = NeoHookean::from_moduli(kC, 0);
  for (int trial = 0; trial < 20; ++trial) {
    const auto F = to_tensor(isochoric(random_gradient(random)));
    const Fibres<double> swapped{kAlongX[1], kAlongX[0]};
    const double alone = energy(matrix, F);
    const double first = energy(fibres(0.1), F, kAlongX) - alone;
    const double second = energy(fibres(0.1), F, swapped) - alone;
    EXPECT_NEAR(energy(fibres(0.1, 2), F, kAlongX), alone + first + second, 1e-10 * kC);
  }
}

}  // namespace
}  // namespace palpate::fem
