// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/rest_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/factor/solve_pool.hpp"
#include "format/error.hpp"
#include "tests/unit/fem/factor/assembled_block.hpp"

namespace palpate::fem {
namespace {

TEST(RestFactor, SolvesEveryRightHandSideInSinglePrecision) {
  const Assembled a;
  const RestFactor factor(a.model.pattern(), nested_dissection(a.model.pattern()), a.K, "block");
  const auto n = a.model.pattern().n;
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, kBatch);
  std::vector<float> block(static_cast<std::size_t>(n) * kBatch), scratch;
  for (int i = 0; i < n; ++i)
    for (int column = 0; column < kBatch; ++column)
      block[to_index(i * kBatch + column)] = static_cast<float>(B(i, column));
  factor.solve(block, scratch);
  const Eigen::MatrixXd X = a.dense.ldlt().solve(B);
  for (int i = 0; i < n; ++i)
    for (int column = 0; column < kBatch; ++column)
      EXPECT_NEAR(block[to_index(i * kBatch + column)], X(i, column), 1e-4 * X.col(column).norm());
}

/// A bar of 100 times its width bends a million times more easily than it stretches.
TEST(RestFactor, IsFactorizedInDoublePrecisionWhereSingleDoesNotSuffice) {
  const auto factor_of = [](double length) {
    const Body body =
        test::make_block(test::even(0, 0.01, 1), test::even(0, 0.01, 1), test::even(0, length, 40));
    const SolidModel model(body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")});
    std::vector<double> K;
    model.stiffness(Displacement::Zero(3, model.mesh().nodes()), K);
    const SparsePattern& pattern = model.pattern();
    const RestFactor factor(pattern, nested_dissection(pattern), K, "bar");
    const Eigen::VectorXd x = Eigen::VectorXd::Ones(pattern.n);
    Eigen::VectorXd b(pattern.n);
    symmetric_multiply(pattern, K, x.data(), b.data());
    std::vector<float> block(to_index(pattern.n) * kBatch, 0.0F), scratch;
    for (int i = 0; i < pattern.n; ++i) block[to_index(i) * kBatch] = static_cast<float>(b[i]);
    factor.solve(block, scratch);
    double error = 0;
    for (int i = 0; i < pattern.n; ++i)
      error = std::max(error, std::abs(block[to_index(i) * kBatch] - 1.0));
    return std::pair(factor.in_double_precision(), error);
  };
  const auto [cube_in_double, cube_error] = factor_of(0.02);
  EXPECT_FALSE(cube_in_double);
  EXPECT_LT(cube_error, 0.01);
  const auto [bar_in_double, bar_error] = factor_of(1);
  EXPECT_TRUE(bar_in_double);
  EXPECT_LT(bar_error, 0.3);  // the factor that is kept is rounded to single precision
}

TEST(RestFactor, GivesARightHandSideTheSameBitsBesideAnyOthers) {
  const Assembled a;
  const RestFactor factor(a.model.pattern(), nested_dissection(a.model.pattern()), a.K, "block");
  const auto n = a.model.pattern().n;
  std::vector<float> alone(static_cast<std::size_t>(n) * kBatch, 0.0f), full = alone, scratch;
  for (int i = 0; i < n; ++i)
    for (int column = 0; column < kBatch; ++column)
      full[to_index(i * kBatch + column)] = static_cast<float>(a.b[(i * (column + 1)) % n]);
  for (int i = 0; i < n; ++i) alone[to_index(i * kBatch + 5)] = full[to_index(i * kBatch + 5)];
  factor.solve(alone, scratch);
  factor.solve(full, scratch);
  for (int i = 0; i < n; ++i)
    ASSERT_EQ(alone[to_index(i * kBatch + 5)], full[to_index(i * kBatch + 5)]);
}

TEST(RestFactor, RefusesAnIndefiniteMatrixAndTooLittleMemory) {
  Assembled a;
  const SparsePattern& pattern = a.model.pattern();
  const std::vector<int> order = nested_dissection(pattern);
  EXPECT_THROW(RestFactor(pattern, order, a.K, "block", {.memory = 1}), Error);  // one byte
  a.K[to_index(pattern.start[5])] = -1;
  EXPECT_THROW(RestFactor(pattern, order, a.K, "block"), Error);
}

TEST(FactorCache, ScalesTheFactorOfAMultipleAndReplacesThatOfAnotherMatrix) {
  Assembled a;
  const SparsePattern& pattern = a.model.pattern();
  FactorCache cache;
  cache.factor_of(pattern, a.K, "block", {});
  std::vector<double> stiffer = a.K;
  for (double& value : stiffer) value *= 3;
  const auto factor = cache.factor_of(pattern, stiffer, "block", {});
  EXPECT_EQ(cache.factorizations(), 1);
  SolvePool pool(*factor, 1);
  SolvePool::Member member(pool);
  Eigen::VectorXd x;
  member.solve(a.b, x);
  const Eigen::VectorXd expected = a.dense.ldlt().solve(a.b) / 3;
  EXPECT_LT((x - expected).norm(), 1e-3 * expected.norm());
  stiffer[to_index(pattern.start[5])] *= 2;
  cache.factor_of(pattern, stiffer, "block", {});
  EXPECT_EQ(cache.factorizations(), 2);
}

}  // namespace
}  // namespace palpate::fem
