// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fitting/measurement/records/statistics.hpp"

namespace palpate::measured {
namespace {

TEST(Statistics, StudentQuantilesAreThoseOfTheTables) {
  // Abramowitz & Stegun 1964, table 26.10, two-sided 95 %.
  EXPECT_NEAR(student_quantile(0.95, 1), 12.706, 1e-3);
  EXPECT_NEAR(student_quantile(0.95, 5), 2.571, 1e-3);
  EXPECT_NEAR(student_quantile(0.95, 30), 2.042, 1e-3);
  EXPECT_NEAR(student_quantile(0.99, 10), 3.169, 1e-3);
}

TEST(Statistics, NormalQuantilesAreThoseOfTheTables) {
  // Abramowitz & Stegun 1964, table 26.5.
  EXPECT_NEAR(normal_quantile(0.95), 1.959964, 1e-6);
  EXPECT_NEAR(normal_quantile(0.90), 1.644854, 1e-6);
  EXPECT_NEAR(student_quantile(0.95, 1e7), normal_quantile(0.95), 1e-6);
}

TEST(Statistics, MeanMedianAndDeviationOfAFewValues) {
  EXPECT_EQ(mean({}), 0);
  EXPECT_EQ(median({}), 0);
  EXPECT_EQ(deviation({3}), 0);
  EXPECT_DOUBLE_EQ(mean({1, 2, 6}), 3);
  EXPECT_EQ(median({6, 1, 2}), 2);
  EXPECT_EQ(median({6, 1, 2, 4}), 3);
  EXPECT_DOUBLE_EQ(deviation({1, 2, 6}), std::sqrt(7.0));
}

TEST(Statistics, ALineHasItsSlopeOffsetAndResidual) {
  const LineFit exact = fit_line({0, 1, 2, 3}, {1, 3, 5, 7});
  EXPECT_NEAR(exact.slope, 2, 1e-14);
  EXPECT_NEAR(exact.offset, 1, 1e-14);
  EXPECT_NEAR(exact.residual, 0, 1e-14);
  const LineFit off = fit_line({0, 1, 2, 3}, {0, 1, 1, 0});  // squares 1, two degrees of freedom
  EXPECT_NEAR(off.slope, 0, 1e-14);
  EXPECT_NEAR(off.residual, std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(off.slope_uncertainty, std::sqrt(0.5 / 5), 1e-14);
}

TEST(Statistics, AScanFindsTheLeastOfSeveralMinima) {
  const auto value = [](double x) { return std::cos(3 * x) + 0.1 * x; };
  EXPECT_NEAR(minimise_scan(value, 0, 6, 60), (M_PI - std::asin(0.1 / 3)) / 3, 1e-6);
}

}  // namespace
}  // namespace palpate::measured
