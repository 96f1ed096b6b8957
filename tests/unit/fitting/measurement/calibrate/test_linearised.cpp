// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/linearised.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace palpate::calibrate {
namespace {

using Vector = Linearised::Vector;
using RowMajor = Linearised::RowMajor;

struct Sample {
  RowMajor J = RowMajor(7, 3);
  Vector r = Vector(7), low = Vector(3), high = Vector(3);

  /// Columns of other sizes that are nearly alike, within a box around 0.
  explicit Sample(unsigned seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<double> room(0, 1);
    for (Eigen::Index row = 0; row < 7; ++row) {
      const double both = normal(engine);
      J.row(row) << both, 1e3 * (both + 0.1 * normal(engine)), 1e-3 * normal(engine);
      r[row] = normal(engine);
    }
    for (Eigen::Index i = 0; i < 3; ++i) {
      low[i] = -room(engine) / J.col(i).norm();
      high[i] = i == 2 ? kInfinite : room(engine) / J.col(i).norm();
    }
  }
  static constexpr double kInfinite = std::numeric_limits<double>::infinity();
};

double cost(const Sample& s, const Vector& p) {
  return 0.5 * (s.r + s.J * p).squaredNorm();
}

/// Karush, Kuhn and Tucker: the slope of the cost is zero where a constant is free, and pushes it
/// out of the box where it is at a bound.
TEST(Linearised, HasTheBestStepWithinBounds) {
  int stopped = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Sample s(seed);
    const Linearised linear(s.J, s.r);
    const Vector p = linear.step(0, s.low, s.high);
    const Vector slope = s.J.transpose() * (s.r + s.J * p);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double size = 1e-9 * s.J.col(i).norm() * s.r.norm();
      EXPECT_GE(p[i], s.low[i]);
      EXPECT_LE(p[i], s.high[i]);
      if (p[i] > s.low[i]) {
        EXPECT_LE(slope[i], size);
      }
      if (p[i] < s.high[i]) {
        EXPECT_GE(slope[i], -size);
      }
      stopped += p[i] == s.low[i] || p[i] == s.high[i] ? 1 : 0;
    }
    EXPECT_NEAR(linear.decrease(p), cost(s, Vector::Zero(3)) - cost(s, p), 1e-12);
  }
  EXPECT_GT(stopped, 20);
}

TEST(Linearised, IsShortWhereItIsDamped) {
  const Sample s(3);
  const Linearised linear(s.J, s.r);
  const Vector infinite = Vector::Constant(3, Sample::kInfinite);
  double length = Sample::kInfinite;
  for (const double damping : {0.0, 1e-2, 1.0, 100.0}) {
    const Vector p = linear.step(damping, -infinite, infinite);
    EXPECT_LT(linear.length(p), length);
    length = linear.length(p);
  }
  EXPECT_LE(length,
            (s.J.transpose() * s.r).cwiseQuotient(s.J.colwise().norm().transpose()).norm() / 100);
}

/// A constant that no residual sees does not move.
TEST(Linearised, LeavesWhatIsNotSeen) {
  Sample s(5);
  s.J.col(1).setZero();
  const Vector p = Linearised(s.J, s.r).step(1e-10, s.low, s.high);
  EXPECT_EQ(p[1], 0);
}

}  // namespace
}  // namespace palpate::calibrate
