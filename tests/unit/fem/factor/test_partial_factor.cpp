// SPDX-License-Identifier: AGPL-3.0-or-later
// The factor of some unknowns and the Schur complement of the others against dense algebra.
#include "fem/factor/partial_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "tests/unit/fem/factor/assembled_block.hpp"

namespace palpate::fem {
namespace {

/// Errors of solutions, over their size; the block is of 10 kPa at nu = 0.49.
double allowed_error(Precision precision) {
  return precision == Precision::Single ? 1e-4 : 1e-9;
}

const std::vector<int> kKept{3, 4, 5, 60, 61, 62, 90, 91, 92};

/// A^-1 has the inverse of the Schur complement as its block.
Eigen::MatrixXd dense_schur_complement(const Eigen::MatrixXd& A, const std::vector<int>& kept) {
  const Eigen::MatrixXd inverse = A.inverse();
  return inverse(kept, kept).inverse();
}

class PartialFactorTest : public testing::TestWithParam<Precision> {
 protected:
  Assembled a_;
  double allowed_ = allowed_error(GetParam());
};

TEST_P(PartialFactorTest, LeavesTheSchurComplementOfTheKeptUnknowns) {
  const std::vector<int> order = nested_dissection(a_.model.pattern());
  for (const auto* permutation : {static_cast<const std::vector<int>*>(nullptr), &order}) {
    PartialFactor factor(a_.model.pattern(), permutation, kKept);
    ASSERT_TRUE(factor.factorize(a_.K, GetParam()));
    ASSERT_TRUE(std::is_permutation(kKept.begin(), kKept.end(), factor.kept().begin(),
                                    factor.kept().end()));
    const Eigen::MatrixXd schur = dense_schur_complement(a_.dense, factor.kept());
    EXPECT_LT((factor.schur_complement() - schur).norm(), allowed_ * schur.norm());
  }
}

TEST_P(PartialFactorTest, BothHalvesMakeASolve) {
  PartialFactor factor(a_.model.pattern(), nullptr, kKept);
  ASSERT_TRUE(factor.factorize(a_.K, GetParam()));
  Eigen::VectorXd load, x;
  factor.solve_forward(a_.b, load);
  factor.solve_backward(factor.schur_complement().ldlt().solve(load), x);
  const Eigen::VectorXd expected = a_.dense.ldlt().solve(a_.b);
  EXPECT_LT((x - expected).norm(), allowed_ * expected.norm());
}

/// A spring of negative stiffness on a kept unknown leaves the others stable.
TEST_P(PartialFactorTest, TheSchurComplementMayBeIndefinite) {
  const auto kept = static_cast<std::size_t>(kKept[4]);
  const double spring = 10 * a_.K[to_index(a_.model.pattern().start[kept])];
  a_.K[to_index(a_.model.pattern().start[kept])] -= spring;
  a_.dense(kKept[4], kKept[4]) -= spring;
  PartialFactor factor(a_.model.pattern(), nullptr, kKept);
  ASSERT_TRUE(factor.factorize(a_.K, GetParam()));
  const Eigen::MatrixXd schur = dense_schur_complement(a_.dense, factor.kept());
  EXPECT_LT(schur.ldlt().vectorD().minCoeff(), 0);
  EXPECT_LT((factor.schur_complement() - schur).norm(), allowed_ * schur.norm());
}

TEST_P(PartialFactorTest, RefusesWhatIsIndefiniteBesideTheKeptUnknowns) {
  a_.K[to_index(a_.model.pattern().start[20])] = -1;
  PartialFactor factor(a_.model.pattern(), nullptr, kKept);
  EXPECT_FALSE(factor.factorize(a_.K, GetParam()));
}

TEST_P(PartialFactorTest, FactorizesAgain) {
  PartialFactor factor(a_.model.pattern(), nullptr, kKept);
  ASSERT_TRUE(factor.factorize(a_.K, GetParam()));
  const Eigen::MatrixXd first = factor.schur_complement();
  for (double& value : a_.K) value *= 3;
  ASSERT_TRUE(factor.factorize(a_.K, GetParam()));
  EXPECT_LT((factor.schur_complement() - 3 * first).norm(), 3 * allowed_ * first.norm());
}

/// Unknowns that nothing couples: none of the supernodes has rows below, and the kept ones are
/// spread over the matrix.
TEST_P(PartialFactorTest, OfAMatrixOfSeveralParts) {
  SparsePattern pattern;
  pattern.n = 6;
  pattern.start = {0, 1, 2, 3, 4, 5, 6};
  pattern.row = {0, 1, 2, 3, 4, 5};
  PartialFactor factor(pattern, nullptr, {0, 3});
  ASSERT_TRUE(factor.factorize({1, 4, 9, 16, 25, 36}, GetParam()));
  EXPECT_DOUBLE_EQ(factor.schur_complement().determinant(), 1 * 16);
  Eigen::VectorXd load, x;
  factor.solve_forward(Eigen::VectorXd::Constant(6, 36), load);
  factor.solve_backward(Eigen::VectorXd::Zero(2), x);
  const Eigen::VectorXd expected{{0, 9, 4, 0, 1.44, 1}};
  EXPECT_LT((x - expected).norm(), allowed_);
  EXPECT_EQ(load, Eigen::Vector2d(36, 36));
}

/// As where the patch of the contact is the whole window.
TEST_P(PartialFactorTest, MayKeepAllUnknowns) {
  SparsePattern pattern;
  pattern.n = 2;
  pattern.start = {0, 2, 3};
  pattern.row = {0, 1, 1};
  PartialFactor factor(pattern, nullptr, {0, 1});
  ASSERT_TRUE(factor.factorize({3, -1, 2}, GetParam()));
  const Eigen::MatrixXd& S = factor.schur_complement();
  EXPECT_DOUBLE_EQ(S.determinant(), 5);
  Eigen::VectorXd load, x;
  factor.solve_forward(Eigen::VectorXd{{1, 1}}, load);
  EXPECT_EQ(load, Eigen::Vector2d(1, 1));
  factor.solve_backward(Eigen::VectorXd{{4, 5}}, x);
  EXPECT_DOUBLE_EQ(x[factor.kept()[0]], 4);
  EXPECT_DOUBLE_EQ(x[factor.kept()[1]], 5);
}

/// What one has left in the memory must not reach the other.
TEST_P(PartialFactorTest, FactorsOnTwoThreadsMayShareTheMemoryOfTheirFronts) {
  PartialFactor alone(a_.model.pattern(), nullptr, kKept);
  ASSERT_TRUE(alone.factorize(a_.K, GetParam()));
  SharedFronts fronts;
  const auto factorize_repeatedly = [&] {
    PartialFactor factor(a_.model.pattern(), nullptr, kKept, &fronts);
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(factor.factorize(a_.K, GetParam()));
      ASSERT_EQ(factor.schur_complement(), alone.schur_complement());
    }
  };
  std::thread other(factorize_repeatedly);
  factorize_repeatedly();
  other.join();
}

TEST_P(PartialFactorTest, HasTheSameBitsOnAnyThreads) {
  PartialFactor alone(a_.model.pattern(), nullptr, kKept),
      factor(a_.model.pattern(), nullptr, kKept);
  ASSERT_TRUE(alone.factorize(a_.K, GetParam()));
  ASSERT_TRUE(factor.factorize(a_.K, GetParam(), 3));
  EXPECT_EQ(factor.schur_complement(), alone.schur_complement());
  EXPECT_LE(alone.bytes(GetParam(), 1), factor.bytes(GetParam(), 3));
}

INSTANTIATE_TEST_SUITE_P(Factor, PartialFactorTest,
                         testing::Values(Precision::Single, Precision::Double),
                         [](const auto& instance) {
                           return instance.param == Precision::Single ? "Single" : "Double";
                         });

}  // namespace
}  // namespace palpate::fem
