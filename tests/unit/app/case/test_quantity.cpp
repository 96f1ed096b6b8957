// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include "app/case/quantity.hpp"

namespace palpate::app {
namespace {

TEST(Quantity, ConvertsUnitsToSi) {
  EXPECT_DOUBLE_EQ(parse_quantity("10 mm", Dimension::Length).value, 0.010);
  EXPECT_DOUBLE_EQ(parse_quantity("2.5cm", Dimension::Length).value, 0.025);
  EXPECT_DOUBLE_EQ(parse_quantity(" 1e4 Pa ", Dimension::Pressure).value, 1e4);
  EXPECT_DOUBLE_EQ(parse_quantity("10 kPa", Dimension::Pressure).value, 1e4);
  EXPECT_DOUBLE_EQ(parse_quantity("180 deg", Dimension::Angle).value, 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(parse_quantity("0.5 N", Dimension::Force).value, 0.5);
  EXPECT_DOUBLE_EQ(parse_quantity("2 kHz", Dimension::Frequency).value, 2000);
  EXPECT_DOUBLE_EQ(parse_quantity("0.081 N s/m", Dimension::Damping).value, 0.081);
}

TEST(Quantity, SaysWhyATextIsNoQuantity) {
  EXPECT_EQ(parse_quantity("ten mm", Dimension::Length).fault, QuantityFault::NoNumber);
  EXPECT_EQ(parse_quantity("", Dimension::Length).fault, QuantityFault::NoNumber);
  EXPECT_EQ(parse_quantity("10", Dimension::Length).fault, QuantityFault::NoUnit);
  EXPECT_EQ(parse_quantity("10 kPa", Dimension::Length).fault, QuantityFault::WrongUnit);
  EXPECT_EQ(parse_quantity("10 mm mm", Dimension::Length).fault, QuantityFault::WrongUnit);
  EXPECT_EQ(parse_quantity("10 MM", Dimension::Length).fault, QuantityFault::WrongUnit);
}

TEST(Quantity, PrintsWhatReadsBackExactly) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-6, 6);
  for (const Dimension dimension : {Dimension::Length, Dimension::Pressure, Dimension::Angle,
                                    Dimension::Stiffness, Dimension::Time}) {
    for (int i = 0; i < 2000; ++i) {
      const double value = std::pow(10, exponent(random));
      const std::string text = print_quantity(value, dimension);
      EXPECT_EQ(parse_quantity(text, dimension).value, value) << text;
    }
  }
  EXPECT_EQ(print_quantity(0.01, Dimension::Length), "10 mm");
  EXPECT_EQ(print_quantity(1e4, Dimension::Pressure), "10 kPa");
}

}  // namespace
}  // namespace palpate::app
