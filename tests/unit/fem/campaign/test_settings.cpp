// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "format/error.hpp"

namespace palpate::fem {
namespace {

std::string refusal(const std::function<void(IndentationSettings&)>& change) {
  IndentationSettings settings;
  change(settings);
  try {
    check_indentation(settings);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "";
}

TEST(Settings, OfAnIndentationHaveValidDefaults) {
  EXPECT_EQ(refusal([](IndentationSettings&) {}), "");
}

TEST(Settings, OfAnIndentationAreCheckedByName) {
  using S = IndentationSettings;
  using testing::HasSubstr;
  EXPECT_THAT(refusal([](S& s) { s.depth = 0; }), HasSubstr("depth"));
  EXPECT_THAT(refusal([](S& s) { s.increments = 0; }), HasSubstr("increments"));
  EXPECT_THAT(refusal([](S& s) { s.force_tolerance = std::numeric_limits<double>::quiet_NaN(); }),
              HasSubstr("force_tolerance"));
  EXPECT_THAT(refusal([](S& s) {
                s.lateral_depths = {0.001, 0.007};
              }),
              HasSubstr("exceeds the depth"));
  EXPECT_THAT(refusal([](S& s) { s.lateral_travel = -1; }), HasSubstr("lateral_travel"));
  EXPECT_THAT(refusal([](S& s) { s.lateral_increments = 0; }), HasSubstr("lateral_increments"));
  EXPECT_THAT(refusal([](S& s) { s.tool.radius = 0; }), HasSubstr("tool_radius"));
  EXPECT_THAT(refusal([](S& s) { s.size_over_contact = 0; }), HasSubstr("size_over_contact"));
}

TEST(Settings, RefineByTheContactOfAnyToolButASharpDisc) {
  const auto with = [](ToolGeometry tool) {
    return [tool](IndentationSettings& s) {
      s.refine_under_tool = IndentationSettings::kByContact;
      s.tool = tool;
      s.friction = ToolFriction::NoSlip;
    };
  };
  EXPECT_EQ(refusal(with({ToolShape::Sphere, 0.005, 0, 0})), "");
  EXPECT_EQ(refusal(with({ToolShape::Disc, 0.005, 0.001, 0})), "");
  EXPECT_EQ(refusal(with({ToolShape::Cylinder, 0.005, 0, 0.02})), "");
  EXPECT_THAT(refusal(with({ToolShape::Disc, 0.005, 0, 0})), testing::HasSubstr("sharp edge"));
}

TEST(Settings, NeedNoLateralValuesWithoutLateralPaths) {
  EXPECT_EQ(refusal([](IndentationSettings& s) {
              s.lateral_depths.clear();
              s.lateral_travel = 0;
            }),
            "");
}

/// Its force is not defined without friction: the surface would flow around the edge.
TEST(Settings, AllowASharpDiscWithoutSlipOnly) {
  const ToolGeometry sharp{ToolShape::Disc, 0.005, 0, 0};
  EXPECT_NE(refusal([&](IndentationSettings& s) { s.tool = sharp; }), "");
  EXPECT_EQ(refusal([&](IndentationSettings& s) {
              s.tool = sharp;
              s.friction = ToolFriction::NoSlip;
            }),
            "");
}

}  // namespace
}  // namespace palpate::fem
