// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/tool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "format/error.hpp"

namespace palpate::fem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::HasSubstr;

const ToolGeometry kSphere{ToolShape::Sphere, 0.005, 0, 0};
const ToolGeometry kSharp{ToolShape::Disc, 0.005, 0, 0};
const ToolGeometry kRounded{ToolShape::Disc, 0.005, 0.001, 0};
const ToolGeometry kCylinder{ToolShape::Cylinder, 0.003, 0, 0.008};

/// Any position, and a direction along no axis.
Tool placed(const ToolGeometry& geometry) {
  const Vector3d inward = Vector3d(0.3, -0.5, -0.8).normalized();
  return {geometry, Vector3d(0.01, 0.02, -0.03), inward, inward.unitOrthogonal()};
}

/// Coordinates: along the axis of a cylinder, across it, and out of the body along the pressing
/// axis.
Vector3d at(const Tool& tool, double along, double across, double out) {
  return tool.tip + along * tool.axis + across * tool.inward.cross(tool.axis) - out * tool.inward;
}

class EachTool : public testing::TestWithParam<ToolGeometry> {};

TEST_P(EachTool, TouchesAtItsTipAndNowhereBelow) {
  const Tool tool = placed(GetParam());
  EXPECT_NEAR(tool.distance(tool.tip), 0, 1e-15);
  EXPECT_NEAR(tool.distance(at(tool, 0, 0, -0.002)), 0.002, 1e-15);
  for (double x = -0.01; x <= 0.01; x += 0.001)
    for (double y = -0.01; y <= 0.01; y += 0.001)
      EXPECT_GT(tool.distance(at(tool, x, y, -1e-9)), 0);
}

TEST_P(EachTool, NormalAndCurvatureAreDerivativesOfTheDistance) {
  const Tool tool = placed(GetParam());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.007, 0.007);
  const double h = 1e-8;
  int smooth = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3d x = at(tool, shift(random), shift(random), shift(random));
    const Gap gap = tool.gap(x);
    EXPECT_NEAR(gap.distance, tool.distance(x), 1e-15);
    EXPECT_NEAR(gap.normal.norm(), 1, 1e-12);
    Vector3d slope;
    Matrix3d bend;
    for (int k = 0; k < 3; ++k) {
      const Vector3d step = h * Vector3d::Unit(k);
      slope[k] = (tool.distance(x + step) - tool.distance(x - step)) / (2 * h);
      bend.col(k) = (tool.gap(x + step).normal - tool.gap(x - step).normal) / (2 * h);
    }
    if (gap.distance < -0.0009) continue;  // across the core of a disc the distance may jump
    EXPECT_LT((slope - gap.normal).norm(), 1e-6);
    EXPECT_LT((bend - gap.curvature).norm(), 1e-4 * (1 + gap.curvature.norm()));
    ++smooth;
  }
  EXPECT_GT(smooth, 100);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EachTool, testing::Values(kSphere, kSharp, kRounded, kCylinder));

TEST(Tool, ARoundedDiscIsATorusAtItsEdge) {
  const Tool tool = placed(kRounded);
  for (const double angle : {0.1, 0.7, 1.4})
    for (const double off : {-0.0005, 0.0, 0.002}) {
      const double r = 0.004 + (0.001 + off) * std::sin(angle);
      const double out = 0.001 - (0.001 + off) * std::cos(angle);
      EXPECT_NEAR(tool.distance(at(tool, 0.6 * r, 0.8 * r, out)), off, 1e-12);
    }
}

TEST(Tool, ASharpDiscPushesPointsWithinItsRadiusAlongItsAxis) {
  const Tool tool = placed(kSharp);
  const Gap gap = tool.gap(at(tool, 0, 0.00499, 0.001));
  EXPECT_NEAR(gap.distance, -0.001, 1e-12);
  EXPECT_LT((gap.normal - tool.inward).norm(), 1e-12);
  EXPECT_GT(tool.distance(at(tool, 0, 0.00501, 0.001)), 0);
}

TEST(Tool, ACylinderHasItsLengthBetweenRoundedEnds) {
  const Tool tool = placed(kCylinder);
  EXPECT_NEAR(tool.distance(at(tool, 0.004, 0, 0)), 0, 1e-15);              // the last of its line
  EXPECT_NEAR(tool.distance(at(tool, 0.004 + 0.003, 0, 0.003)), 0, 1e-15);  // the pole of its end
  EXPECT_NEAR(tool.distance(at(tool, 0.001, 0.003, 0.003)), 0, 1e-15);
  EXPECT_DOUBLE_EQ(kCylinder.extent(), 0.007);
  EXPECT_DOUBLE_EQ(kRounded.extent(), 0.005);
}

std::string refusal(const ToolGeometry& geometry) {
  try {
    check_tool(geometry);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "accepted";
}

TEST(Tool, BadSizesAreNamedWithTheirRange) {
  for (const auto& good : {kSphere, kSharp, kRounded, kCylinder})
    EXPECT_EQ(refusal(good), "accepted");
  EXPECT_THAT(refusal({ToolShape::Sphere, 0, 0, 0}), HasSubstr("tool_radius = 0 mm"));
  EXPECT_THAT(refusal({ToolShape::Sphere, std::nan(""), 0, 0}), HasSubstr("tool_radius"));
  EXPECT_THAT(refusal({ToolShape::Disc, 0.005, 0.006, 0}), HasSubstr("edge_radius = 6.00 mm"));
  EXPECT_THAT(refusal({ToolShape::Disc, 0.005, -1e-9, 0}), HasSubstr("edge_radius"));
  EXPECT_THAT(refusal({ToolShape::Disc, 0.005, std::nan(""), 0}), HasSubstr("edge_radius"));
  EXPECT_THAT(refusal({ToolShape::Sphere, 0.005, 0.001, 0}), HasSubstr("only a disc"));
  EXPECT_THAT(refusal({ToolShape::Disc, 0.005, 0, 0.01}), HasSubstr("only a cylinder"));
  EXPECT_THAT(refusal({ToolShape::Cylinder, 0.005, 0, 0}), HasSubstr("length = 0 mm"));
}

}  // namespace
}  // namespace palpate::fem
