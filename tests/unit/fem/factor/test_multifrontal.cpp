// SPDX-License-Identifier: AGPL-3.0-or-later
// The factorization by fronts against dense algebra, and its independence of the threads.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <new>
#include <numeric>

#include "fem/factor/multifrontal.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {
namespace {

constexpr int kGroups = 5, kOfGroup = 150, kShared = 600;

/// Groups of unknowns that are coupled only through common ones, which come last: the front of
/// each group is larger than two tiles.
struct Star {
  SparsePattern pattern;
  std::vector<double> values;
  Eigen::MatrixXd dense;
  std::vector<int> order;

  Star() {
    const int own = kGroups * kOfGroup;
    pattern.n = own + kShared;
    pattern.start.push_back(0);
    for (int j = 0; j < pattern.n; ++j) {
      const int end = j < own ? (j / kOfGroup + 1) * kOfGroup : pattern.n;
      for (int i = j; i < end; ++i) pattern.row.push_back(i);
      for (int i = std::max(j, own); j < own && i < pattern.n; ++i) pattern.row.push_back(i);
      pattern.start.push_back(static_cast<int>(pattern.row.size()));
    }
    dense = Eigen::MatrixXd::Zero(pattern.n, pattern.n);
    for (int j = 0; j < pattern.n; ++j)
      for (int e = pattern.start[to_index(j)]; e < pattern.start[to_index(j) + 1]; ++e) {
        const int i = pattern.row[to_index(e)];
        const double value = i == j ? pattern.n : std::sin(1.0 + 3.0 * i + 7.0 * j);
        values.push_back(value);
        dense(i, j) = dense(j, i) = value;
      }
    order.resize(to_index(pattern.n));
    std::iota(order.begin(), order.end(), 0);
  }
};

/// Columns of L, one supernode after the other, and of each its first column.
template <class Number>
struct Columns {
  std::vector<std::vector<Number>> of;
  bool definite = false;
};

template <class Number = double>
Columns<Number> columns_of(const Star& star, const Cholesky& analysis, int threads) {
  const SupernodalView view = analysis.view();
  Columns<Number> columns;
  columns.of.resize(to_index(view.supernodes));
  std::mutex mutex;
  columns.definite = Multifrontal(star.pattern, view)
                         .factorize<Number>(star.values, threads, [&](int k, const Number* x) {
                           const int rows = view.row_start[k + 1] - view.row_start[k];
                           const int width = view.first_column[k + 1] - view.first_column[k];
                           const std::lock_guard lock(mutex);
                           columns.of[to_index(k)].assign(x, x + std::ptrdiff_t{rows} * width);
                         });
  return columns;
}

/// Compares the columns with those of the dense factor.
template <class Number>
void expect_dense_factor(double tolerance) {
  const Star star;
  const Cholesky analysis(star.pattern, &star.order);
  const SupernodalView view = analysis.view();
  const Columns<Number> columns = columns_of<Number>(star, analysis, 2);
  ASSERT_TRUE(columns.definite);
  const Eigen::Map<const Eigen::VectorXi> order(view.permutation, star.pattern.n);
  const Eigen::MatrixXd ordered = star.dense(order, order);
  const Eigen::MatrixXd L = ordered.llt().matrixL();
  Eigen::Index compared = 0;
  for (int k = 0; k < view.supernodes; ++k) {
    const int rows = view.row_start[k + 1] - view.row_start[k], first = view.first_column[k];
    for (int j = 0; j < view.first_column[k + 1] - first; ++j)
      for (int i = j; i < rows; ++i, ++compared)
        ASSERT_NEAR(columns.of[to_index(k)][to_index(j) * to_index(rows) + to_index(i)],
                    L(view.rows[view.row_start[k] + i], first + j), tolerance);
  }
  EXPECT_GE(compared, star.pattern.nonzeros());
}

TEST(Multifrontal, ComputesTheFactorOfTheDenseMatrix) {
  expect_dense_factor<double>(1e-10);
}

/// The entries of L are up to 37.
TEST(Multifrontal, ComputesItInSinglePrecision) {
  expect_dense_factor<float>(1e-5);
}

TEST(Multifrontal, HasTheSameBitsOnAnyNumberOfThreads) {
  const Star star;
  const Cholesky analysis(star.pattern, &star.order);
  const Columns<double> alone = columns_of(star, analysis, 1);
  ASSERT_TRUE(alone.definite);
  for (const int threads : {2, 3, 7})
    for (int again = 0; again < 3; ++again) {
      const Columns<double> columns = columns_of(star, analysis, threads);
      ASSERT_TRUE(columns.definite);
      for (std::size_t k = 0; k < alone.of.size(); ++k)
        ASSERT_EQ(std::memcmp(alone.of[k].data(), columns.of[k].data(),
                              alone.of[k].size() * sizeof(double)),
                  0);
    }
}

TEST(Multifrontal, RefusesAnIndefiniteMatrix) {
  for (const int unknown : {3, kGroups * kOfGroup + kShared - 1})
    for (const int threads : {1, 4}) {
      Star star;
      star.values[to_index(star.pattern.start[to_index(unknown)])] = -1;
      const Cholesky analysis(star.pattern, &star.order);
      EXPECT_FALSE(columns_of(star, analysis, threads).definite) << unknown << " " << threads;
    }
}

TEST(Multifrontal, RethrowsAnExceptionOfTheCallback) {
  const Star star;
  const Cholesky analysis(star.pattern, &star.order);
  const Multifrontal fronts(star.pattern, analysis.view());
  for (const int threads : {1, 3})
    EXPECT_THROW(fronts.factorize<double>(star.values, threads,
                                          [](int, const double*) { throw std::bad_alloc(); }),
                 std::bad_alloc);
}

TEST(EliminationPlan, CountsTheMemoryOfGroupsWithACommonFront) {
  const Star star;
  const Cholesky analysis(star.pattern, &star.order);
  ASSERT_EQ(analysis.view().supernodes, kGroups);  // the last group is one with those shared
  const EliminationTree tree(analysis.view());
  const EliminationPlan alone(tree, 1);
  const double update = 1.0 * kShared * kShared;
  const double last = 1.0 * (kShared + kOfGroup) * (kShared + kOfGroup);
  EXPECT_DOUBLE_EQ(alone.update_numbers, (kGroups - 1) * update);
  EXPECT_DOUBLE_EQ(alone.column_numbers, last);
  EXPECT_EQ(alone.parts.size(), 1u);
  const EliminationPlan two(tree, 2);
  EXPECT_EQ(two.parts.size(), to_index(kGroups - 1));
  EXPECT_EQ(two.top, std::vector<int>{kGroups - 1});
  EXPECT_GE(two.update_numbers, alone.update_numbers);
  EXPECT_DOUBLE_EQ(two.column_numbers, 2 * last);
}

}  // namespace
}  // namespace palpate::fem
