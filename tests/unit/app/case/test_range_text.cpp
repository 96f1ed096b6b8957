// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/range_text.hpp"

#include <gtest/gtest.h>

namespace palpate::app {
namespace {

TEST(RangeText, NamesBothEnds) {
  EXPECT_EQ(range_text(kAny), "any finite value");
  EXPECT_EQ(range_text(kPositive), "> 0");
  EXPECT_EQ(range_text(kNotNegative), ">= 0");
  EXPECT_EQ(range_text({.low = 2, .high = 1000}), "2 .. 1000");
  EXPECT_EQ(range_text({.low = 0, .high = 1, .low_open = true, .high_open = true}),
            "0 .. 1, both ends excluded");
  EXPECT_EQ(range_text({.low = 0, .high = 0.1, .low_open = true}), "0 .. 0.1, lower end excluded");
  EXPECT_EQ(range_text({.low = 0, .high = 0.5, .high_open = true}), "0 .. 0.5, upper end excluded");
}

TEST(RangeText, HasTheUnitOfTheDimension) {
  EXPECT_EQ(range_text(kPositive, Dimension::Length), "> 0 mm");
  EXPECT_EQ(range_text({.low = 100, .high = 1e5}, Dimension::Frequency), "0.1 kHz .. 100 kHz");
}

}  // namespace
}  // namespace palpate::app
