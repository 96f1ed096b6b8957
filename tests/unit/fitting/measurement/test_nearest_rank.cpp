// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/nearest_rank.hpp"

#include <gtest/gtest.h>

namespace palpate::fitting {
namespace {

TEST(NearestRank, IsTheLeastValueThatTheFractionDoesNotExceed) {
  EXPECT_EQ(nearest_rank(1, 0.95), 0U);
  EXPECT_EQ(nearest_rank(100, 0.95), 94U);
  EXPECT_EQ(nearest_rank(101, 0.95), 95U);
  EXPECT_EQ(nearest_rank(4, 0.5), 1U);
  EXPECT_EQ(nearest_rank(5, 0.5), 2U);
  EXPECT_EQ(nearest_rank(5, 0), 0U);
  EXPECT_EQ(nearest_rank(5, 1), 4U);
}

}  // namespace
}  // namespace palpate::fitting
