// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/trial_sites.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::app {
namespace {

using testing::ElementsAre;

TEST(TrialSites, AreSpreadOverAll) {
  EXPECT_THAT(spread({2, 3, 5, 7, 11, 13, 17, 19}, 2), ElementsAre(5, 17));
  EXPECT_THAT(spread({2, 3, 5}, 1), ElementsAre(3));
}

/// A wedge that is 2 mm thick at one end and 20 mm at the other.
TEST(TrialSites, AreInTheOrderOfTheThicknessOfTheBody) {
  Body wedge =
      test::make_block(test::even(0, 0.06, 6), test::even(0, 0.04, 4), test::even(-0.02, 0, 2));
  for (Vec3& x : wedge.nodes) x[2] *= 0.1 + 0.9 * x[0] / 0.06;
  std::vector<std::int32_t> sites;
  for (std::size_t v = 0; v < wedge.response.node.size(); ++v)
    if (wedge.response.is_site[v] != 0) sites.push_back(static_cast<std::int32_t>(v));
  const std::vector<std::int32_t> ordered =
      by_thickness(wedge, {sites.rbegin(), sites.rend()}, 0.003);
  EXPECT_THAT(ordered, testing::UnorderedElementsAreArray(sites));
  double before = 0;
  for (const std::int32_t v : ordered) {
    const double x = wedge.nodes[to_index(wedge.response.node[to_index(v)])][0];
    EXPECT_GE(x, before - 1e-12);
    before = x;
  }
}

TEST(TrialSites, AreAllWhereThereAreFew) {
  EXPECT_THAT(spread({2, 3, 5}, 3), ElementsAre(2, 3, 5));
  EXPECT_THAT(spread({2, 3, 5}, 8), ElementsAre(2, 3, 5));
}

}  // namespace
}  // namespace palpate::app
