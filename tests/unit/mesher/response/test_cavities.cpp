// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/response/cavities.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(Cavities, VerticesOnTheirWallsAreNoSites) {
  Surface boundary = test::box({0, 0, 0}, {1, 1, 1});
  Surface cavity = test::sphere({0.5, 0.5, 0.5}, 0.2, 16);
  for (Triangle& t : cavity.triangles) std::swap(t[1], t[2]);  // its outside is the body
  append(boundary, cavity);
  Body body;
  body.response.triangles = boundary.triangles;
  body.response.is_site.assign(boundary.points.size(), 1);
  std::string said;
  exclude_cavities(body, boundary, [&](std::string_view line) { said += line; });
  EXPECT_EQ(std::count(body.response.is_site.begin(), body.response.is_site.begin() + 8, 1), 8);
  EXPECT_EQ(std::count(body.response.is_site.begin() + 8, body.response.is_site.end(), 1), 0);
  EXPECT_NE(said.find("1 cavity"), std::string::npos) << said;
}

}  // namespace
}  // namespace palpate::mesher
