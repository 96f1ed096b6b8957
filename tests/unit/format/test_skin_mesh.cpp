// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/skin_mesh.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(SkinMesh, HasTheCornersOfTheBoundaryAndTheFacetsBetweenThem) {
  Body body;  // node 1 is inside, nodes 0, 2, 3, 4 on the skin
  body.nodes = {{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  body.boundary = {{0, 2, 4}, {0, 4, 3}};
  body.response.node = {4, 0};
  const SkinMesh skin = skin_mesh(body);
  EXPECT_EQ(skin.node, (std::vector<std::int32_t>{0, 2, 3, 4}));
  EXPECT_EQ(skin.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(skin.triangles, (std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}}));
  EXPECT_EQ(skin.vertex_of, (std::vector<std::int32_t>{3, 0}));
}

}  // namespace
}  // namespace palpate
