// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/tangent_frame.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

/// For normals all around, among them those on either side of the change of axis.
TEST(TangentFrame, IsRightHandedAndOrthonormalForEveryNormal) {
  for (const double x : {-1.0, -0.7, -0.6, -0.599, 0.0, 0.599, 0.6, 0.7, 1.0})
    for (int k = 0; k < 12; ++k) {
      const double r = std::sqrt(1 - x * x), angle = 0.5236 * k;
      const Vec3 n{x, r * std::cos(angle), r * std::sin(angle)};
      const auto [a, b] = tangent_frame(n);
      EXPECT_NEAR(norm(a), 1, 1e-15);
      EXPECT_NEAR(dot(a, n), 0, 1e-15);
      EXPECT_LT(norm(cross(a, b) - n), 1e-15);
    }
}

}  // namespace
}  // namespace palpate
