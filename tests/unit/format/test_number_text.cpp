// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

namespace palpate {
namespace {

TEST(NumberText, HasThreeSignificantDigitsAtEverySize) {
  EXPECT_EQ(number_text(1.2345), "1.23");
  EXPECT_EQ(number_text(0.0012345), "0.00123");
  EXPECT_EQ(number_text(123.45), "123");
  EXPECT_EQ(number_text(-0.5), "-0.500");
  EXPECT_EQ(number_text(9.996), "10.0");
  EXPECT_EQ(number_text(12345), "12345");
  EXPECT_EQ(number_text(1.2345e-7), "1.23e-07");
  EXPECT_EQ(number_text(1.2345e8), "1.23e+08");
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(std::nan("")), "unknown");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "infinite");
}

TEST(NumberText, RoundsBoundsUpAndByLessThanAThousandth) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> exponent(-9, 9);
  for (int i = 0; i < 10000; ++i) {
    const double value = std::pow(10, exponent(engine));
    const double text = std::strtod(rounded_up_text(value).c_str(), nullptr);
    ASSERT_GE(text, value);
    ASSERT_LE(text, value * 1.0010001);
  }
  EXPECT_EQ(rounded_up_text(99.999), "100.0");
  EXPECT_EQ(rounded_up_text(2.5), "2.500");
  EXPECT_EQ(rounded_up_text(0), "0");
}

TEST(NumberText, ForcesHaveTheUnitOfTheirSize) {
  EXPECT_EQ(force_text(2.5), "2.50 N");
  EXPECT_EQ(force_text(0.0834), "83.4 mN");
  EXPECT_EQ(force_text(8.34e-6), "8.34 uN");
  EXPECT_EQ(force_text(0), "0 N");
}

TEST(NumberText, EnergiesHaveTheUnitOfTheirSize) {
  EXPECT_EQ(energy_text(5010), "5010 J");
  EXPECT_EQ(energy_text(0.346), "346 mJ");
  EXPECT_EQ(energy_text(0.346e-3), "0.346 mJ");
  EXPECT_EQ(energy_text(-9.677e-6), "-9.68 uJ");
  EXPECT_EQ(energy_text(3.4e-12), "0.00340 nJ");
  EXPECT_EQ(energy_text(0), "0 mJ");
}

TEST(NumberText, FractionsArePercents) {
  EXPECT_EQ(percent_text(0.1734), "17 %");
  EXPECT_EQ(percent_text(0.0042), "0.42 %");
  EXPECT_EQ(percent_text(1e-6), "below 0.01 %");
  EXPECT_EQ(percent_text(0), "0 %");
}

TEST(NumberText, LengthsHaveTheUnitThatFits) {
  EXPECT_EQ(length_text(0.0124), "12.4 mm");
  EXPECT_EQ(length_text(0.25e-3), "0.250 mm");
  EXPECT_EQ(length_text(-25e-6), "-25.0 um");
  EXPECT_EQ(length_text(0.4e-6), "0.400 um");
  EXPECT_EQ(length_text(7e-9), "7.00 nm");
  EXPECT_EQ(length_text(0), "0 mm");
  EXPECT_EQ(length_text(std::nan("")), "unknown mm");
}

TEST(NumberText, OneThingIsSingular) {
  EXPECT_EQ(count_text(0, "site"), "0 sites");
  EXPECT_EQ(count_text(1, "site"), "1 site");
  EXPECT_EQ(count_text(2U, "site"), "2 sites");
  EXPECT_EQ(count_text(1, "press", "presses"), "1 press");
  EXPECT_EQ(count_text(std::int64_t{21}, "press", "presses"), "21 presses");
}

}  // namespace
}  // namespace palpate
