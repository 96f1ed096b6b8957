// SPDX-License-Identifier: AGPL-3.0-or-later
// The cone of friction, against the angle of friction.
#include "format/friction_cone.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

TEST(FrictionCone, EndsAtTheAngleOfFriction) {
  const double friction = 0.3, angle = std::atan(friction);
  const Vec3 inward{0, 0.6, -0.8}, along{1, 0, 0}, across{0, 0.8, 0.6};
  for (const Vec3& aside : {along, across, -1.0 * along})
    for (const double size : {1e-6, 1.0, 40.0}) {
      const auto at = [&](double a) { return size * (std::cos(a) * inward + std::sin(a) * aside); };
      EXPECT_TRUE(within_friction(at(0.999 * angle), inward, friction));
      EXPECT_FALSE(within_friction(at(1.001 * angle), inward, friction));
    }
}

TEST(FrictionCone, HoldsNoPull) {
  EXPECT_FALSE(within_friction({0, 0, 1}, {0, 0, -1}, 0.3));
  EXPECT_TRUE(within_friction({0, 0, -1}, {0, 0, -1}, 0));
}

}  // namespace
}  // namespace palpate
