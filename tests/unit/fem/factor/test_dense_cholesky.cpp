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

/// What is not to be read is not a number.
Eigen::MatrixXd lower_only(const Eigen::MatrixXd& A) {
  Eigen::MatrixXd lower =
      Eigen::MatrixXd::Constant(A.rows(), A.cols(), std::numeric_limits<double>::quiet_NaN());
  lower.triangularView<Eigen::Lower>() = A;
  return lower;
}

/// min(i, j), counted from one: every number of L is 1, so is every pivot.
Eigen::MatrixXd of_ones(int n) {
  return Eigen::MatrixXd::NullaryExpr(
      n, n, [](Eigen::Index i, Eigen::Index j) { return static_cast<double>(std::min(i, j) + 1); });
}

TEST(DenseCholesky, OfAMatrixOfKnownFactor) {
  for (const int n : kSizes) {
    Eigen::MatrixXd A = lower_only(of_ones(n));
    ASSERT_TRUE(factorize_in_place(A));
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = j; i < n; ++i) EXPECT_NEAR(A(i, j), 1, 1e-12);
  }
}

/// The inverse of min(i, j) is the second difference with a free end.
template <class Number>
void expect_second_differences(double tolerance) {
  for (const int n : kSizes) {
    const Eigen::VectorX<Number> b = Eigen::VectorX<Number>::Random(n);
    Eigen::MatrixX<Number> A = lower_only(of_ones(n)).cast<Number>();
    ASSERT_TRUE(factorize_in_place(A));
    const Eigen::VectorX<Number> x = solve_factorized(A, b);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Number before = i > 0 ? b[i] - b[i - 1] : b[i];
      const Number after = i + 1 < n ? b[i + 1] - b[i] : Number{0};
      EXPECT_NEAR(x[i], before - after, tolerance);
    }
  }
}

TEST(DenseCholesky, SolvesWithTheLowerTriangle) {
  expect_second_differences<double>(1e-12);
}

/// With 200 unknowns the condition of min(i, j) is 7e4.
TEST(DenseCholesky, SolvesInSinglePrecision) {
  expect_second_differences<float>(1e-5);
}

/// The Schur complement of the first unknowns of min(i, j) is min(i, j), counted from the last of
/// them; what is eliminated first and last is the whole factor.
TEST(DenseCholesky, EliminatesTheFirstUnknowns) {
  for (const int n : kSizes)
    for (const int first : {0, n / 2, n}) {
      Eigen::MatrixXd A = lower_only(of_ones(n));
      ASSERT_TRUE(eliminate_first(first, A));
      for (Eigen::Index j = 0; j < n; ++j)
        for (Eigen::Index i = j; i < n; ++i)
          EXPECT_NEAR(A(i, j), j < first ? 1 : static_cast<double>(j + 1 - first), 1e-11);
      Eigen::VectorXd x = Eigen::VectorXd::Ones(n);
      solve_first_forward(A, first, x);
      solve_first_backward(A, first, x);
      for (Eigen::Index i = 0; i < n; ++i)
        EXPECT_NEAR(x[i], i == 0 && first > 0 ? 1 : (i < first ? 0 : 1), 1e-12);
    }
}

TEST(DenseCholesky, RefusesAnIndefiniteMatrix) {
  for (const int n : kSizes) {
    Eigen::MatrixXd A = of_ones(n);
    A(n - 1, n - 1) -= 1.5;  // the last pivot is 1
    EXPECT_FALSE(factorize_in_place(A));
  }
}

}  // namespace
}  // namespace palpate::fem
