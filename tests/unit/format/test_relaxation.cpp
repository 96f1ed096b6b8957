// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/relaxation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/format/refusal.hpp"

namespace palpate {
namespace {

void expect_refused(const RelaxationSeries& series, const std::string& problem) {
  samples::expect_refusal([&] { check_relaxation(series, "liver"); }, ErrorKind::Configuration,
                          "liver", problem);
}

TEST(Relaxation, FallsFromOneToTheLongTermFractionAsTheSumOfItsExponentials) {
  const RelaxationSeries series{{0.3, 0.1}, {0.2, 2}};
  EXPECT_DOUBLE_EQ(relaxed_fraction(series, 0), 1);
  EXPECT_NEAR(relaxed_fraction(series, 0.1), 0.5 + 0.3 / std::exp(1) + 0.2 * std::exp(-0.05),
              1e-15);
  EXPECT_DOUBLE_EQ(relaxed_fraction(series, 1e3), long_term_fraction(series));
  EXPECT_DOUBLE_EQ(long_term_fraction(series), 0.5);
  EXPECT_EQ(relaxed_fraction({}, 1), 1);
}

TEST(Relaxation, RefusesWhatIsNoSeries) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  check_relaxation({}, "elastic");
  check_relaxation({{0.3, 0.1}, {0.69, 0.2}}, "liver");
  expect_refused({{0, 1}}, "relaxation[0].fraction = 0");
  expect_refused({{0.3, 0.1}, {-0.1, 1}}, "relaxation[1].fraction = -0.1");
  expect_refused({{nan, 1}}, "relaxation[0].fraction");
  expect_refused({{0.3, 0}}, "relaxation[0].time = 0");
  expect_refused({{0.3, nan}}, "relaxation[0].time");
  expect_refused({{0.3, 1}, {0.3, 0.1}}, "not above the time before");
  expect_refused({{0.3, 1}, {0.3, 1}}, "not above the time before");
  expect_refused({{0.6, 1}, {0.4, 2}}, "sum to 1");
}

TEST(Relaxation, RegionsShareTheUnionOfTheirTimes) {
  const double nearly = 0.7 * (1 + 1e-15);
  const RegionRelaxation merged =
      over_one_list({{{0.3, 0.1}, {0.2, 0.7}}, {}, {{0.4, nearly}, {0.1, 10}}}, "body");
  ASSERT_EQ(merged.times_s.size(), 3U);
  EXPECT_EQ(merged.times_s[0], 0.1);
  EXPECT_DOUBLE_EQ(merged.times_s[1], 0.7);
  EXPECT_EQ(merged.times_s[2], 10);
  const std::vector<std::vector<double>> fractions{{0.3, 0.2, 0}, {0, 0, 0}, {0, 0.4, 0.1}};
  EXPECT_EQ(merged.fractions, fractions);
  EXPECT_TRUE(over_one_list({{}, {}}, "body").empty());
}

}  // namespace
}  // namespace palpate
