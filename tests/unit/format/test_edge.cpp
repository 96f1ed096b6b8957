// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/edge.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Edge, HasNoDirection) {
  EXPECT_EQ(edge_between(7, 3), edge_between(3, 7));
  EXPECT_EQ(edge_between(7, 3), (Edge{3, 7}));
}

TEST(EdgesOf, ListsEachEdgeOfTrianglesOnceAscending) {
  EXPECT_EQ(edges_of({{0, 1, 2}, {2, 1, 3}}),
            (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}}));
  EXPECT_TRUE(edges_of({}).empty());
}

}  // namespace
}  // namespace palpate
