// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/range.hpp"

#include <gtest/gtest.h>

#include <random>

namespace palpate::fitting {
namespace {

/// Whether a range contains an exact value, which long double represents to 11 bits more.
bool contains(const Range& range, long double exact) {
  return static_cast<long double>(range.low) <= exact &&
         exact <= static_cast<long double>(range.high);
}

/// One rounding to nearest is not enough to contain the exact value: both ends must be outward.
TEST(Range, OperationsOnSingleNumbersContainTheExactResult) {
  std::mt19937 engine(61);
  std::uniform_real_distribution<double> u(-3, 3);
  int inexact = 0;
  for (int i = 0; i < 20000; ++i) {
    const double a = u(engine), b = u(engine), p = std::abs(b) + 0.01;
    const long double A = a, B = b, P = p;
    const Range x{a, a}, y{b, b}, z{p, p};
    EXPECT_TRUE(contains(x + y, A + B));
    EXPECT_TRUE(contains(x - y, A - B));
    EXPECT_TRUE(contains(x * y, A * B));
    EXPECT_TRUE(contains(a * y, A * B));
    EXPECT_TRUE(contains(x / z, A / P));
    EXPECT_TRUE(contains(square(x), A * A));
    EXPECT_TRUE(contains(root(z), std::sqrt(P)));
    inexact += static_cast<long double>(a * b) != A * B ? 1 : 0;
  }
  EXPECT_GT(inexact, 15000);  // round to nearest alone would have failed these
}

TEST(Range, OperationsOnRangesContainTheResultsOfAllTheirNumbers) {
  std::mt19937 engine(62);
  std::uniform_real_distribution<double> u(-2, 2), v(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const double a = u(engine), b = u(engine), c = 0.1 + std::abs(u(engine));
    const Range x{a, a + v(engine)}, y{b, b + v(engine)}, z{c, c + v(engine)};
    for (int k = 0; k < 10; ++k) {
      const auto in = [&](const Range& r) { return r.low + (r.high - r.low) * v(engine); };
      const long double p = in(x), q = in(y), r = in(z);
      EXPECT_TRUE(contains(x + y, p + q));
      EXPECT_TRUE(contains(x - y, p - q));
      EXPECT_TRUE(contains(x * y, p * q));
      EXPECT_TRUE(contains(x / z, p / r));
      EXPECT_TRUE(contains(square(x), p * p));
      EXPECT_TRUE(contains(root(z), std::sqrt(r)));
    }
  }
}

TEST(Range, ZeroIsExact) {
  const Range zero{}, x{-1.1, 2.3}, y{0.1, 0.1};
  for (const Range& r : {zero * x, zero + zero, y - y, zero / y}) {
    EXPECT_EQ(r.low, 0);
    EXPECT_EQ(r.high, 0);
  }
}

TEST(Range, WideningIsOfTheOrderOfRounding) {
  const Range x{0.1, 0.7};
  const Range sum = x + x;
  EXPECT_NEAR(sum.low, 0.2, 1e-15);
  EXPECT_NEAR(sum.high, 1.4, 1e-15);
}

/// A bound that is infinite must not become one that is no number: that compares as no bound at
/// all.
TEST(Range, InfinityStaysInfinity) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double infinity : {kInf, -kInf}) {
    EXPECT_EQ(round_up(infinity), infinity);
    EXPECT_EQ(round_down(infinity), infinity);
  }
  const Range unbounded = Range{-kInf, kInf} + Range{1, 2};
  EXPECT_EQ(unbounded.low, -kInf);
  EXPECT_EQ(unbounded.high, kInf);
}

TEST(Range, HullAndCommonAreUnionAndIntersection) {
  const Range a{0, 2}, b{1, 3};
  EXPECT_EQ(hull(a, b).low, 0);
  EXPECT_EQ(hull(a, b).high, 3);
  EXPECT_EQ(common(a, b).low, 1);
  EXPECT_EQ(common(a, b).high, 2);
}

}  // namespace
}  // namespace palpate::fitting
