// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/trial_sites.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palpate::app {
namespace {

using testing::ElementsAre;

TEST(TrialSites, AreSpreadOverAll) {
  EXPECT_THAT(spread({2, 3, 5, 7, 11, 13, 17, 19}, 2), ElementsAre(5, 17));
  EXPECT_THAT(spread({2, 3, 5}, 1), ElementsAre(3));
}

TEST(TrialSites, AreAllWhereThereAreFew) {
  EXPECT_THAT(spread({2, 3, 5}, 3), ElementsAre(2, 3, 5));
  EXPECT_THAT(spread({2, 3, 5}, 8), ElementsAre(2, 3, 5));
}

}  // namespace
}  // namespace palpate::app
