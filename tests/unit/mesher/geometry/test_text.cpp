// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "mesher/geometry/text.hpp"

namespace palpate::mesher {
namespace {

TEST(Text, CountsAndLengthsAsAUserReadsThem) {
  EXPECT_EQ(counted(1, "edge"), "1 edge");
  EXPECT_EQ(counted(2, "edge"), "2 edges");
  EXPECT_EQ(counted(0, "vertex", "vertices"), "0 vertices");
  EXPECT_EQ(millimetres(0.0125), "12.5 mm");
}

TEST(Text, NoteDoesNothingWithoutALog) {
  std::string lines;
  note({}, "lost");
  note([&](std::string_view line) { lines += line; }, "logged");
  EXPECT_EQ(lines, "logged");
}

}  // namespace
}  // namespace palpate::mesher
