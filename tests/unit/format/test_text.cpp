// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/text.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Trimmed, TakesBlanksFromTheEndsOnly) {
  EXPECT_EQ(trimmed(" \t a b\r"), "a b");
  EXPECT_EQ(trimmed("a"), "a");
  EXPECT_EQ(trimmed(" \t\r"), "");
  EXPECT_EQ(trimmed(""), "");
  EXPECT_EQ(trimmed("a\n"), "a\n");  // a line end is the business of who reads lines
}

TEST(ThreeDigits, AreSignificantOnes) {
  EXPECT_EQ(three_digits(1234), "1.23e+03");
  EXPECT_EQ(three_digits(0.00123456), "0.00123");
  EXPECT_EQ(three_digits(12), "12");
}

}  // namespace
}  // namespace palpate
