// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesher/geometry/quality.hpp"

namespace palpate::mesher {
namespace {

TEST(Quality, RegularTetrahedron) {
  const std::vector<Vec3> nodes = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const Quality quality = measure_quality(nodes, {{0, 1, 3, 2}});
  EXPECT_NEAR(quality.smallest_dihedral, std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(quality.largest_dihedral, quality.smallest_dihedral, 1e-12);
  EXPECT_NEAR(quality.largest_edge_ratio, 1, 1e-14);
  EXPECT_NEAR(std::abs(quality.volume), 8.0 / 3, 1e-14);
}

TEST(Quality, RightAngledCorner) {
  const std::vector<Vec3> nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Quality quality = measure_quality(nodes, {{0, 1, 2, 3}});
  EXPECT_NEAR(quality.smallest_dihedral, std::acos(1 / std::sqrt(3.0)) * 180 / std::numbers::pi,
              1e-12);
  EXPECT_NEAR(quality.largest_dihedral, 90, 1e-12);
  EXPECT_NEAR(quality.largest_edge_ratio, std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(quality.volume, 1.0 / 6, 1e-15);
}

}  // namespace
}  // namespace palpate::mesher
