// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <optional>
#include <random>

#include "fitting/response/nnls.hpp"

namespace palpate::fitting {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Problem {
  MatrixXd A;
  VectorXd b;
};

Problem random_problem(std::mt19937& engine, Eigen::Index rows, Eigen::Index columns) {
  std::normal_distribution<double> normal;
  Problem problem{MatrixXd(rows, columns), VectorXd(rows)};
  for (double& value : problem.A.reshaped()) value = normal(engine);
  for (double& value : problem.b.reshaped()) value = normal(engine);
  return problem;
}

/// Minimum over all 2^n choices of free variables, each solved by the normal equations.
double enumerated_minimum(const Problem& problem) {
  const Eigen::Index n = problem.A.cols();
  double least = problem.b.squaredNorm();
  for (unsigned set = 1; set < (1u << n); ++set) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index j = 0; j < n; ++j) {
      if ((set >> j) & 1u) columns.push_back(j);
    }
    const MatrixXd part = problem.A(Eigen::all, columns);
    const VectorXd x = (part.transpose() * part).ldlt().solve(part.transpose() * problem.b);
    if (x.minCoeff() < 0) continue;
    least = std::min(least, (part * x - problem.b).squaredNorm());
  }
  return least;
}

TEST(NonnegativeLeastSquares, MeetsTheConditionsOfOptimality) {
  std::mt19937 engine(7);
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Index columns = 1 + trial % 15;
    const Problem p = random_problem(engine, columns + trial % 20, columns);
    const VectorXd x = nonnegative_least_squares(p.A, p.b);
    const VectorXd w = p.A.transpose() * (p.b - p.A * x);
    ASSERT_EQ(x.size(), columns);
    EXPECT_GE(x.minCoeff(), 0);
    EXPECT_LE(w.maxCoeff(), 1e-10);
    for (Eigen::Index j = 0; j < columns; ++j) {
      EXPECT_NEAR(x[j] * w[j], 0, 1e-9);  // no force on a variable that is free
    }
  }
}

TEST(NonnegativeLeastSquares, AgreesWithTheEnumerationOfActiveSets) {
  std::mt19937 engine(11);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Index columns = 1 + trial % 7;
    const Problem p = random_problem(engine, 12, columns);
    const VectorXd x = nonnegative_least_squares(p.A, p.b);
    EXPECT_NEAR((p.A * x - p.b).squaredNorm(), enumerated_minimum(p), 1e-10);
  }
}

TEST(NonnegativeLeastSquares, HandlesEqualAndZeroColumns) {
  std::mt19937 engine(13);
  Problem p = random_problem(engine, 10, 4);
  p.A.col(1) = p.A.col(0);
  p.A.col(3).setZero();
  const VectorXd x = nonnegative_least_squares(p.A, p.b);
  EXPECT_GE(x.minCoeff(), 0);
  EXPECT_EQ(x[3], 0);
  EXPECT_LE((p.A.transpose() * (p.b - p.A * x)).maxCoeff(), 1e-10);
}

TEST(NonnegativeLeastSquares, IsIndependentOfTheUnitsOfAColumn) {
  std::mt19937 engine(17);
  const Problem p = random_problem(engine, 12, 5);
  Problem scaled = p;
  const VectorXd units = (VectorXd(5) << 1e-9, 1e6, 1, 1e3, 1e-4).finished();
  scaled.A = p.A * units.asDiagonal();
  const VectorXd x = nonnegative_least_squares(p.A, p.b);
  const VectorXd y = nonnegative_least_squares(scaled.A, scaled.b);
  for (Eigen::Index j = 0; j < 5; ++j) EXPECT_NEAR(y[j] * units[j], x[j], 1e-9);
}

}  // namespace
}  // namespace palpate::fitting
