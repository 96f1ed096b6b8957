// SPDX-License-Identifier: AGPL-3.0-or-later
// Dense factors by BLAS against matrices whose factors are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "fem/factor/dense_cholesky.hpp"

namespace palpate::fem {
namespace {

/// Sizes around powers of two, at which BLAS changes its ways.
constexpr int kSizes[]{1, 3, 63, 64, 65, 200};

/// min(i, j), counted from one: every number of L is 1, so is every pivot, and what a factorization
/// computes are whole numbers, without rounding. Only the lower triangle: what is not to be read is
/// not a number.
template <class Number>
Eigen::MatrixX<Number> of_ones(int n) {
  Eigen::MatrixX<Number> lower =
      Eigen::MatrixX<Number>::Constant(n, n, std::numeric_limits<Number>::quiet_NaN());
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) lower(i, j) = static_cast<Number>(j + 1);
  return lower;
}

template <class Number>
void expect_ones() {
  for (const int n : kSizes) {
    Eigen::MatrixX<Number> A = of_ones<Number>(n);
    ASSERT_TRUE(factorize_in_place(A.data(), n, n));
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = j; i < n; ++i) EXPECT_EQ(A(i, j), 1);
  }
}

TEST(DenseCholesky, OfAMatrixOfKnownFactor) {
  expect_ones<double>();
  expect_ones<float>();
}

/// The inverse of min(i, j) is the second difference with a free end. With 200 unknowns its
/// condition is 7e4.
TEST(DenseCholesky, SolvesWithTheLowerTriangle) {
  for (const int n : kSizes) {
    const Eigen::VectorXf b = Eigen::VectorXf::Random(n);
    Eigen::MatrixXf A = of_ones<float>(n);
    ASSERT_TRUE(factorize_in_place(A));
    const Eigen::VectorXf x = solve_factorized(A, b);
    for (Eigen::Index i = 0; i < n; ++i) {
      const float before = i > 0 ? b[i] - b[i - 1] : b[i];
      const float after = i + 1 < n ? b[i + 1] - b[i] : 0;
      EXPECT_NEAR(x[i], before - after, 1e-5);
    }
  }
}

/// The Schur complement of the first unknowns of min(i, j) is min(i, j), counted from the last of
/// them; what is eliminated first and last is the whole factor.
TEST(DenseCholesky, EliminatesTheFirstUnknowns) {
  for (const int n : kSizes)
    for (const int first : {0, n / 2, n}) {
      Eigen::MatrixXf A = of_ones<float>(n);
      ASSERT_TRUE(eliminate_first(first, A));
      for (Eigen::Index j = 0; j < n; ++j)
        for (Eigen::Index i = j; i < n; ++i)
          EXPECT_EQ(A(i, j), j < first ? 1 : static_cast<float>(j + 1 - first));
      Eigen::VectorXf x = Eigen::VectorXf::Ones(n);
      solve_first_forward(A, first, x);
      solve_first_backward(A, first, x);
      for (Eigen::Index i = 0; i < n; ++i)
        EXPECT_EQ(x[i], i == 0 && first > 0 ? 1 : (i < first ? 0 : 1));
    }
}

TEST(DenseCholesky, RefusesAnIndefiniteMatrix) {
  for (const int n : kSizes) {
    Eigen::MatrixXf A = of_ones<float>(n);
    A(n - 1, n - 1) -= 1.5F;  // the last pivot is 1
    EXPECT_FALSE(factorize_in_place(A));
  }
}

}  // namespace
}  // namespace palpate::fem
