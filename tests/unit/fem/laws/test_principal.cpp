// SPDX-License-Identifier: AGPL-3.0-or-later
// Jacobi's rotations against Eigen's QR iteration.
#include "fem/laws/principal.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/unit/fem/laws/law_samples.hpp"

namespace palpate::fem {
namespace {

template <class T>
Eigen::Vector3d direction(const PrincipalStretches<T>& found, std::size_t i) {
  return Eigen::Map<const Eigen::Vector3d>(found.N[i].data());
}

/// The stretches are those of Eigen's solver, the directions orthonormal, and C is their sum.
void expect_decomposed(const Matrix& C) {
  const auto found = principal_stretches(to_tensor(C));
  Eigen::Vector3d squared(found.squared.data());
  std::sort(squared.data(), squared.data() + 3);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> expected(C);
  const double scale = C.norm();
  EXPECT_LT((squared - expected.eigenvalues()).norm(), 1e-13 * scale);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    sum += found.squared[i] * direction(found, i) * direction(found, i).transpose();
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(direction(found, i).dot(direction(found, j)), i == j ? 1 : 0, 1e-14);
  }
  EXPECT_LT((sum - C).norm(), 1e-13 * scale);
}

/// Stretches from a fiftieth to twenty, far beyond those of a solid that a tool presses.
TEST(PrincipalStretches, AreThoseOfTheTensorWhateverTheirDirections) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> logarithm(std::log(0.02), std::log(20));
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Vector3d l(std::exp(logarithm(random)), std::exp(logarithm(random)),
                              std::exp(logarithm(random)));
      const Matrix R = random_rotation(random);
      expect_decomposed(R * l.cwiseAbs2().asDiagonal() * R.transpose());
    }
  }
}

TEST(PrincipalStretches, MayBeEqualOrNearlySo) {
  std::mt19937 random(1);
  for (const double apart : {0.0, 1e-15, 1e-9, 1e-5}) {
    const Matrix R = random_rotation(random);
    for (const Eigen::Vector3d& l :
         {Eigen::Vector3d(1, 1 + apart, 1 - apart), Eigen::Vector3d(2, 2 + apart, 0.3),
          Eigen::Vector3d(0.1, 3, 3 + apart)})
      expect_decomposed(R * l.asDiagonal() * R.transpose());
  }
}

TEST(PrincipalStretches, OfADiagonalTensorAreItsEntriesInTheirOrder) {
  const Matrix C = Eigen::Vector3d(3, 0.5, 7).asDiagonal();
  const auto found = principal_stretches(to_tensor(C));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.squared[i], C(static_cast<int>(i), static_cast<int>(i)));
    EXPECT_EQ(std::abs(found.N[i][i]), 1);
  }
}

/// As many rotations for one as for eight: the laws rely on it.
TEST(PrincipalStretches, AreTheSameInEverySimdLane) {
  std::mt19937 random(2);
  Tensor2<Lanes> C;
  std::array<Tensor2<double>, kLanes> single;
  for (int lane = 0; lane < kLanes; ++lane) {
    const Matrix F = random_gradient(random);
    single[to_index(lane)] = gram(to_tensor(F));
    for (std::size_t i = 0; i < 9; ++i) C[i][lane] = single[to_index(lane)][i];
  }
  const auto all = principal_stretches(C);
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto one = principal_stretches(single[to_index(lane)]);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(all.squared[i][lane], one.squared[i], 1e-13 * one.squared[i]);
  }
}

}  // namespace
}  // namespace palpate::fem
