// SPDX-License-Identifier: AGPL-3.0-or-later
// The laws against their own definitions (differences, objectivity) and against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "fem/at.hpp"
#include "fem/material.hpp"
#include "format/error.hpp"

namespace palpate::fem {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

NeoHookean tissue(double nu = 0.49) {
  return NeoHookean::from_young_poisson(10e3, nu, "tissue");
}

Tensor2<double> to_tensor(const Matrix& m) {
  Tensor2<double> t;
  Eigen::Map<Matrix>(t.data()) = m;
  return t;
}

Matrix random_gradient(std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-0.3, 0.3);
  Matrix F = Matrix::Identity();
  for (int i = 0; i < 9; ++i) F(i / 3, i % 3) += entry(random);
  return F;
}

/// Full energy density and stress, isochoric and volumetric together.
double energy(const NeoHookean& law, const Matrix& F) {
  const double J = F.determinant();
  return law.psi(to_tensor(F), J) + law.volumetric_energy(J);
}
Tensor2<double> stress(const NeoHookean& law, const Matrix& F) {
  const auto t = to_tensor(F);
  const auto cof = cofactor(t);
  const double J = determinant(t, cof);
  auto P = law.piola(t, cof, J);
  for (std::size_t i = 0; i < 9; ++i) P[i] += law.pressure(J) * cof[i];
  return P;
}

TEST(NeoHookean, RestIsStressFree) {
  for (const double p : stress(tissue(), Matrix::Identity())) EXPECT_NEAR(p, 0, 1e-10);
  EXPECT_NEAR(energy(tissue(), Matrix::Identity()), 0, 1e-12);
}

TEST(NeoHookean, SmallStrainModuliAreTheGivenOnes) {
  const double h = 1e-6;
  Matrix shear = Matrix::Identity(), swell = (1 + h) * Matrix::Identity();
  shear(0, 1) = h;
  EXPECT_NEAR(stress(tissue(), shear)[1] / h, 10e3 / (2 * 1.49), 1e-2);
  EXPECT_NEAR(stress(tissue(), swell)[0] / (3 * h), 10e3 / (3 * 0.02), 1);
}

TEST(NeoHookean, StressIsTheDerivativeOfTheEnergy) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix F = random_gradient(random);
    const auto P = stress(tissue(), F);
    for (int i = 0; i < 9; ++i) {
      Matrix plus = F, minus = F;
      const double h = 1e-5;
      plus(i / 3, i % 3) += h;
      minus(i / 3, i % 3) -= h;
      EXPECT_NEAR(P[at(i)], (energy(tissue(), plus) - energy(tissue(), minus)) / (2 * h),
                  1e-6 * tissue().kappa());
    }
  }
}

TEST(NeoHookean, TangentIsTheDerivativeOfTheIsochoricStress) {
  std::mt19937 random(2);
  const auto isochoric = [](const Matrix& F) {
    const auto t = to_tensor(F);
    return tissue().piola(t, cofactor(t), F.determinant());
  };
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix F = random_gradient(random);
    Tensor4<double> A{};
    tissue().add_tangent(to_tensor(F), cofactor(to_tensor(F)), F.determinant(), A);
    for (int i = 0; i < 9; ++i) {
      Matrix plus = F, minus = F;
      const double h = 1e-5;
      plus(i / 3, i % 3) += h;
      minus(i / 3, i % 3) -= h;
      const auto high = isochoric(plus), low = isochoric(minus);
      for (std::size_t j = 0; j < 9; ++j)
        EXPECT_NEAR(A[j][at(i)], (high[j] - low[j]) / (2 * h), 1e-5 * tissue().mu());
    }
  }
}

TEST(NeoHookean, IsObjectiveAndIsotropic) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix F = random_gradient(random);
    const Matrix R = Eigen::AngleAxisd(0.3 + trial, Eigen::Vector3d(1, 2, trial).normalized())
                         .toRotationMatrix();
    const double W = energy(tissue(), F);
    EXPECT_NEAR(energy(tissue(), R * F), W, 1e-9 * W);
    EXPECT_NEAR(energy(tissue(), F * R), W, 1e-9 * W);
  }
}

/// Closed forms of the incompressible neo-Hookean solid with mu = 1, nominal stress: uniaxial
/// P = l - l^-2, equibiaxial l - l^-5, pure shear l - l^-3. The compressibility left at
/// nu = 0.499999 changes them by less than 1e-4.
TEST(NeoHookean, ApproachesTheIncompressibleClosedForms) {
  const auto law = NeoHookean::from_young_poisson(2 * (1 + 0.499999), 0.499999, "test");
  // Loaded stretches given, the free one found by bisection on a traction-free face.
  const auto nominal = [&](double a, bool a_free_twice, double b) {
    double low = 0.3, high = 2;
    for (int i = 0; i < 200; ++i) {
      const double free = 0.5 * (low + high);
      const Matrix F = Eigen::Vector3d(a, a_free_twice ? free : b, free).asDiagonal();
      (stress(law, F)[8] < 0 ? low : high) = free;
    }
    const Matrix F = Eigen::Vector3d(a, a_free_twice ? low : b, low).asDiagonal();
    return stress(law, F)[0];
  };
  EXPECT_NEAR(nominal(0.9, true, 0), -0.334568, 1e-4);
  EXPECT_NEAR(nominal(1.3, true, 0), 0.708284, 1e-4);
  EXPECT_NEAR(nominal(1.3, false, 1.3), 1.030671, 2e-4);
  EXPECT_NEAR(nominal(1.3, false, 1.0), 0.844834, 1e-4);
}

TEST(NeoHookean, LanesEqualScalars) {
  std::mt19937 random(4);
  Tensor2<Lanes> F;
  std::array<Matrix, kLanes> single;
  for (int lane = 0; lane < kLanes; ++lane) {
    single[at(lane)] = random_gradient(random);
    for (int i = 0; i < 9; ++i) F[at(i)][lane] = single[at(lane)](i / 3, i % 3);
  }
  const auto cof = cofactor(F);
  const Lanes J = determinant(F, cof);
  const auto P = tissue().piola(F, cof, J);
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto t = to_tensor(single[at(lane)]);
    const auto expected = tissue().piola(t, cofactor(t), single[at(lane)].determinant());
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(P[i][lane], expected[i], 1e-9 * tissue().mu());
  }
}

TEST(NeoHookean, RefusesConstantsOutOfRangeByName) {
  const auto message = [](double E, double nu) -> std::string {
    try {
      NeoHookean::from_young_poisson(E, nu, "liver");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(-1, 0.4), testing::HasSubstr("young"));
  EXPECT_NE(message(std::nan(""), 0.4).find("nan"), std::string::npos);
  EXPECT_NE(message(1e3, 0.5).find("poisson (nu) = 0.5"), std::string::npos);
  EXPECT_NE(message(1e3, -0.1).find("0 <= nu < 0.5"), std::string::npos);
  EXPECT_NE(message(1e3, 0.5).find("liver"), std::string::npos);
}

}  // namespace
}  // namespace palpate::fem
