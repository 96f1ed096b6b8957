// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/error.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/skin/remesh.hpp"
#include "mesher/volume/fill.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(Fill, RefinesToTheRequestedEdgeAndKeepsEveryTriangle) {
  const NestedSurface nested =
      remesh(test::box({0, 0, 0}, {0.05, 0.05, 0.05}), {0.008, 2, 45}, "box", {});
  std::size_t coarser = 0;
  for (const double longest : {0.012, 0.006}) {
    const Filling filling = fill(nested.boundary, longest, "box");
    EXPECT_FALSE(filling.cut_short);
    const Quality quality = measure_quality(filling.nodes, filling.tetrahedra);
    EXPECT_NEAR(quality.volume, 1.25e-4, 1e-15);
    EXPECT_LT(quality.longest_edge, 1.2 * longest);
    EXPECT_GT(quality.smallest_dihedral, 5);
    EXPECT_GT(filling.nodes.size(), coarser);
    coarser = filling.nodes.size();
  }
}

TEST(Fill, IntersectingShellsAreAnErrorNotACrash) {
  Surface crossed = test::sphere({0, 0, 0}, 0.03, 32);
  append(crossed, test::sphere({0.02, 0, 0}, 0.03, 32));
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      fill(crossed, 0.01, "crossed");
      FAIL() << "filled";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Geometry);
      EXPECT_THAT(error.what(), testing::HasSubstr("TetGen cannot fill"));
    }
  }
}

}  // namespace
}  // namespace palpate::mesher
