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

}  // namespace
}  // namespace palpate
