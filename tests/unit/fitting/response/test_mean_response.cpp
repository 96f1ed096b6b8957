// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/mean_response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/response_curve.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

double force(const ResponseCurve& curve, double d) {
  return runtime::CompiledCurve(curve).force(d);
}

TEST(MeanResponse, OfLinearResponsesHasTheMeanStiffness) {
  const NodeResponse soft = node_response(linear_curve(100), linear_curve(40));
  const NodeResponse stiff = node_response(linear_curve(200), linear_curve(80));
  FitSettings settings;
  settings.relative_tolerance = settings.absolute_tolerance = 1e-4;
  const NodeResponse mean = mean_response({{&soft, 0.25}, {&stiff, 0.75}}, settings, "test");
  EXPECT_EQ(mean.status, ResponseStatus::Interpolated);
  for (const double d : {0.002, 0.005, 0.01}) {
    EXPECT_NEAR(force(mean.lateral, d), 70 * d, 0.002 * 70 * d);
    // The normal response starts with slope zero, so only its end is the mean.
    EXPECT_LE(force(mean.normal, d), 175 * d * 1.1);
  }
  EXPECT_EQ(mean.normal_error, 0);
}

TEST(MeanResponse, IsWithinToleranceOfTheWeightedForces) {
  std::mt19937 engine(3);
  FitSettings settings;
  for (int trial = 0; trial < 10; ++trial) {
    const NodeResponse a = random_response(engine, 0.3), b = random_response(engine, 0.3);
    const NodeResponse mean = mean_response({{&a, 0.6}, {&b, 0.4}}, settings, "test");
    for (int i = 1; i <= 8; ++i) {
      const double d = 0.001 * i;
      const double expected = 0.6 * force(a.normal, d) + 0.4 * force(b.normal, d);
      EXPECT_NEAR(force(mean.normal, d), expected, std::max(0.02 * expected, 0.01));
    }
  }
}

TEST(MeanResponse, IsMonotoneForNegativeWeights) {
  const NodeResponse soft = node_response(linear_curve(10), linear_curve(10));
  const NodeResponse stiff = node_response(linear_curve(200), linear_curve(200));
  const NodeResponse mean = mean_response({{&soft, 1.5}, {&stiff, -0.5}}, {}, "test");
  for (const float slope : mean.normal.slope) EXPECT_GE(slope, 0.0F);
  for (const float slope : mean.lateral.slope) EXPECT_GE(slope, 0.0F);
}

/// The sign of a soft axis means nothing, and neither does that of the mean.
TEST(MeanResponse, HasTheLongerAxisOfTheMeanOfSoftAxes) {
  NodeResponse one = node_response(linear_curve(100), linear_curve(40)), other = one;
  const auto mean_of = [&](double first, double second) {
    const Vec3 b = vec3_of(mean_response({{&one, first}, {&other, second}}, {}, "test").soft_axis);
    return std::array<double, 3>{b[0] * b[0], b[1] * b[1], b[0] * b[1]};
  };
  EXPECT_EQ(mean_of(0.5, 0.5), (std::array<double, 3>{}));
  one.soft_axis = {0.3F, 0.1F, 0};
  other.soft_axis = {-0.3F, -0.1F, 0};
  for (const double value : {mean_of(0.5, 0.5)[0], mean_of(0.2, 0.8)[0]})
    EXPECT_NEAR(value, 0.09, 1e-6);
  EXPECT_NEAR(mean_of(0.5, 0.5)[2], 0.03, 1e-6);
  // Axes across each other: the mean tensor is diagonal, with 0.7 * 0.16 and 0.3 * 0.04.
  one.soft_axis = {0.4F, 0, 0};
  other.soft_axis = {0, 0.2F, 0};
  EXPECT_NEAR(mean_of(0.7, 0.3)[0], 0.7 * 0.16, 1e-6);
  EXPECT_NEAR(mean_of(0.7, 0.3)[1], 0, 1e-6);
  // A mean with a negative weight is no longer than the longest.
  EXPECT_NEAR(mean_of(1.5, -0.5)[0], 0.16, 1e-6);
}

TEST(MeanResponse, LargestDifferenceOfLinearResponsesIsAtTheEnd) {
  const ResponseDifference difference =
      largest_difference(node_response(linear_curve(100), linear_curve(40)),
                         node_response(linear_curve(130), linear_curve(80)));
  EXPECT_NEAR(difference.normal, 30 * 0.01, 1e-6);
  EXPECT_NEAR(difference.lateral, 40 * 0.01, 1e-6);
}

}  // namespace
}  // namespace palpate::fitting
