// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <deque>
#include <thread>

#include "fem/factor/rest_factor.hpp"
#include "fem/solid/solid_model.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

struct Assembled {
  Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, 0.02, 2));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")}};
  std::vector<double> K;
  Eigen::MatrixXd dense;
  Eigen::VectorXd b;

  Assembled() {
    const auto& pattern = model.pattern();
    model.stiffness(Displacement::Zero(3, model.mesh().nodes()), K);
    dense = Eigen::MatrixXd::Zero(pattern.n, pattern.n);
    for (int c = 0; c < pattern.n; ++c)
      for (std::size_t k = to_index(pattern.start[to_index(c)]);
           k < to_index(pattern.start[to_index(c) + 1]); ++k)
        dense(pattern.row[k], c) = dense(c, pattern.row[k]) = K[k];
    b = Eigen::VectorXd::Random(pattern.n);
  }
};

TEST(SparsePattern, ProductEqualsTheDenseOne) {
  const Assembled a;
  Eigen::VectorXd y(a.b.size());
  symmetric_multiply(a.model.pattern(), a.K, a.b.data(), y.data());
  EXPECT_LT((y - a.dense * a.b).norm(), 1e-12 * y.norm());
}

TEST(Cholesky, SolvesAsADenseFactorizationDoes) {
  const Assembled a;
  Cholesky factor(a.model.pattern());
  ASSERT_TRUE(factor.factorize(a.K));
  SolveWorkspace workspace;
  Eigen::VectorXd x(a.b.size());
  factor.solve(a.b.data(), x.data(), workspace);
  const Eigen::VectorXd expected = a.dense.ldlt().solve(a.b);
  EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm());
}

TEST(Cholesky, SaysWhenTheMatrixIsIndefinite) {
  Assembled a;
  a.K[to_index(a.model.pattern().start[5])] = -1;
  Cholesky factor(a.model.pattern());
  EXPECT_FALSE(factor.factorize(a.K));
}

TEST(Cholesky, EndsWithTheSchurComplementOfTheLastUnknowns) {
  const Assembled a;
  const std::vector<int> last{3, 4, 5, 60, 61, 62, 90, 91, 92};
  const std::vector<int> order = nested_dissection(a.model.pattern());
  for (const auto* permutation : {static_cast<const std::vector<int>*>(nullptr), &order}) {
    Cholesky factor(a.model.pattern(), permutation, last);
    ASSERT_TRUE(factor.factorize(a.K));
    const std::vector<int> found = factor.last_unknowns();
    ASSERT_TRUE(std::is_permutation(found.begin(), found.end(), last.begin(), last.end()));
    const Eigen::MatrixXd L = factor.last_block();
    const Eigen::MatrixXd inverse = a.dense.inverse();
    const Eigen::MatrixXd schur = inverse(found, found).inverse();
    EXPECT_LT((L * L.transpose() - schur).norm(), 1e-9 * schur.norm());
  }
}

TEST(Cholesky, KeepsTheOrderOfTheLastWhereTheMatrixFallsIntoParts) {
  SparsePattern pattern;  // diagonal
  pattern.n = 6;
  pattern.start = {0, 1, 2, 3, 4, 5, 6};
  pattern.row = {0, 1, 2, 3, 4, 5};
  Cholesky factor(pattern, nullptr, {0, 3});
  ASSERT_TRUE(factor.factorize({1, 4, 9, 16, 25, 36}));
  const std::vector<int> found = factor.last_unknowns();
  const std::vector<int> last{0, 3};
  EXPECT_TRUE(std::is_permutation(found.begin(), found.end(), last.begin(), last.end()));
  EXPECT_NEAR(factor.last_block().determinant(), 1 * 4, 1e-12);
}

TEST(Cholesky, TwoHalvesOfASolveMakeTheWhole) {
  const Assembled a;
  Cholesky factor(a.model.pattern(), nullptr, {10, 40});
  ASSERT_TRUE(factor.factorize(a.K));
  SolveWorkspace workspace;
  Eigen::VectorXd y(a.b.size()), x(a.b.size());
  factor.solve_forward(a.b.data(), y.data(), workspace);
  EXPECT_NEAR(y.squaredNorm(), a.b.dot(a.dense.ldlt().solve(a.b)), 1e-9 * y.squaredNorm());
  factor.solve_backward(y.data(), x.data(), workspace);
  EXPECT_LT((a.dense * x - a.b).norm(), 1e-9 * a.b.norm());
}

TEST(RestFactor, SolvesEveryLaneInSinglePrecision) {
  const Assembled a;
  const RestFactor factor(a.model.pattern(), nested_dissection(a.model.pattern()), a.K, "block");
  const auto n = a.model.pattern().n;
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, kBatch);
  std::vector<float> block(static_cast<std::size_t>(n) * kBatch), scratch;
  for (int i = 0; i < n; ++i)
    for (int lane = 0; lane < kBatch; ++lane)
      block[to_index(i * kBatch + lane)] = static_cast<float>(B(i, lane));
  factor.solve(block, scratch);
  const Eigen::MatrixXd X = a.dense.ldlt().solve(B);
  for (int i = 0; i < n; ++i)
    for (int lane = 0; lane < kBatch; ++lane)
      EXPECT_NEAR(block[to_index(i * kBatch + lane)], X(i, lane), 1e-4 * X.col(lane).norm());
}

TEST(RestFactor, ALaneHasTheSameBitsWhateverStandsBesideIt) {
  const Assembled a;
  const RestFactor factor(a.model.pattern(), nested_dissection(a.model.pattern()), a.K, "block");
  const auto n = a.model.pattern().n;
  std::vector<float> alone(static_cast<std::size_t>(n) * kBatch, 0.0f), crowd = alone, scratch;
  for (int i = 0; i < n; ++i)
    for (int lane = 0; lane < kBatch; ++lane)
      crowd[to_index(i * kBatch + lane)] = static_cast<float>(a.b[(i * (lane + 1)) % n]);
  for (int i = 0; i < n; ++i) alone[to_index(i * kBatch + 5)] = crowd[to_index(i * kBatch + 5)];
  factor.solve(alone, scratch);
  factor.solve(crowd, scratch);
  for (int i = 0; i < n; ++i)
    ASSERT_EQ(alone[to_index(i * kBatch + 5)], crowd[to_index(i * kBatch + 5)]);
}

TEST(SolveBatch, ServesAllMembersAndLetsThemLeave) {
  const Assembled a;
  const RestFactor factor(a.model.pattern(), nested_dissection(a.model.pattern()), a.K, "block");
  const Eigen::VectorXd expected = a.dense.ldlt().solve(a.b);
  SolveBatch batch(factor, 3);
  std::vector<double> error(3, 1.0);
  std::vector<std::thread> threads;
  for (int lane = 0; lane < 3; ++lane)
    threads.emplace_back([&, lane] {
      SolveBatch::Member member(batch);
      Eigen::VectorXd x;
      for (int turn = 0; turn <= 2 * lane; ++turn) member.solve((lane + 1.0) * a.b, x);
      error[to_index(lane)] = (x - (lane + 1.0) * expected).norm() / expected.norm();
    });
  for (auto& thread : threads) thread.join();
  for (const double e : error) EXPECT_LT(e, 1e-3);
}

/// Seven sites in one batch, none in the other: some move, and nobody's solution changes.
TEST(SolveBatch, MembersMoveToWhereFewerAre) {
  const Assembled a;
  const RestFactor factor(a.model.pattern(), nested_dissection(a.model.pattern()), a.K, "block");
  Eigen::VectorXd alone;
  {
    SolveBatch batch(factor, 1);
    SolveBatch::Member(batch).solve(a.b, alone);
  }
  std::deque<SolveBatch> crew;
  for (const int members : {7, 0}) crew.emplace_back(factor, members, &crew);
  std::vector<int> most(7, 0), wrong(7, 0);
  std::vector<std::thread> threads;
  for (int i = 0; i < 7; ++i)
    threads.emplace_back([&, i] {
      SolveBatch::Member member(crew[0]);
      Eigen::VectorXd x;
      for (int turn = 0; turn < 50; ++turn) {
        member.solve(a.b, x);
        if (x != alone) ++wrong[to_index(i)];
        most[to_index(i)] = std::max(most[to_index(i)], crew[1].members());
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(*std::max_element(wrong.begin(), wrong.end()), 0);
  EXPECT_GE(*std::max_element(most.begin(), most.end()), 1);
  EXPECT_LE(*std::max_element(most.begin(), most.end()), 3);  // a fourth would be one too many
  for (const SolveBatch& batch : crew) EXPECT_EQ(batch.members(), 0);
}

}  // namespace
}  // namespace palpate::fem
