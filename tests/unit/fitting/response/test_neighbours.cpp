// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/neighbours.hpp"

#include <gtest/gtest.h>

#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

TEST(Neighbours, OfAnIcosahedronAreTheFiveAtTheEdgeLength) {
  const Library library = sphere(1, 0);
  const auto neighbours = neighbours_of(library);
  ASSERT_EQ(neighbours.size(), 12u);
  const double edge = norm(library.positions[0] - library.positions[11]);
  for (std::size_t a = 0; a < 12; ++a)
    for (std::size_t b = 0; b < 12; ++b) {
      const bool adjacent =
          a != b && norm(library.positions[a] - library.positions[b]) < 1.01 * edge;
      EXPECT_EQ(neighbours[a].count(b) == 1, adjacent) << a << ", " << b;
    }
}

TEST(Neighbours, AVertexWithoutATriangleHasNone) {
  Library library = flat_triangle();
  library.positions.push_back({1, 0, 0});
  EXPECT_TRUE(neighbours_of(library)[3].empty());
}

}  // namespace
}  // namespace palpate::fitting
