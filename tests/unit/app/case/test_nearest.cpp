// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/nearest.hpp"

#include <gtest/gtest.h>

namespace palpate::app {
namespace {

TEST(Nearest, FindsTheWordThatWasMeant) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);  // the textbook pair
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("same", "same"), 0U);
  EXPECT_EQ(nearest("yuong", {"poisson", "young", "law"}), "young");
  EXPECT_EQ(nearest("x", {}), "");
  EXPECT_EQ(meant_instead("yuong", {"poisson", "young"}, "the nearest"), "the nearest is 'young'");
  EXPECT_EQ(meant_instead("colour", {"law", "moduli"}, "the nearest"), "known are law, moduli");
}

}  // namespace
}  // namespace palpate::app
