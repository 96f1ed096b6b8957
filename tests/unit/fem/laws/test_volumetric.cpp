// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/laws/volumetric.hpp"

#include <gtest/gtest.h>

namespace palpate::fem {
namespace {

constexpr double kKappa = 5e4;  // Pa

TEST(LogQuadraticVolume, HasItsDerivativesAndTheBulkModulusAtRest) {
  const LogQuadraticVolume volume(kKappa);
  EXPECT_EQ(volume.volumetric_energy(1.0), 0);
  EXPECT_EQ(volume.pressure(1.0), 0);
  EXPECT_DOUBLE_EQ(volume.pressure_slope(1.0), kKappa);
  for (const double J : {0.2, 0.7, 1.0, 1.4, 3.0}) {
    const double h = 1e-5 * J;
    const auto slope = [&](const auto& f) { return (f(J + h) - f(J - h)) / (2 * h); };
    EXPECT_NEAR(volume.pressure(J), slope([&](double x) { return volume.volumetric_energy(x); }),
                1e-7 * kKappa);
    EXPECT_NEAR(volume.pressure_slope(J), slope([&](double x) { return volume.pressure(x); }),
                1e-7 * kKappa * volume.pressure_slope(J) / kKappa);
  }
}

/// The mean dilatation rests on convexity, and det F > 0 on the barrier at 0.
TEST(LogQuadraticVolume, IsConvexAndResistsCollapse) {
  const LogQuadraticVolume volume(kKappa);
  double last = volume.pressure(1e-3);
  for (double J = 2e-3; J < 5; J *= 1.3) {
    EXPECT_GT(volume.pressure(J), last);
    last = volume.pressure(J);
  }
  EXPECT_GT(volume.volumetric_energy(1e-30), 30 * kKappa);
  EXPECT_LT(volume.pressure(1e-6), -1e5 * kKappa);
}

TEST(LogQuadraticVolume, IsTheSameInEverySimdLane) {
  const LogQuadraticVolume volume(kKappa);
  const Lanes J = Lanes::LinSpaced(0.3, 2.1);
  const Lanes U = volume.volumetric_energy(J), p = volume.pressure(J);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_NEAR(U[lane], volume.volumetric_energy(J[lane]), 1e-13 * kKappa);
    EXPECT_NEAR(p[lane], volume.pressure(J[lane]), 1e-13 * kKappa);
  }
}

}  // namespace
}  // namespace palpate::fem
