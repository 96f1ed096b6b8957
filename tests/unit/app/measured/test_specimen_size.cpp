// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/specimen_size.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "format/error.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

std::string area_refusal(const SpecimenSize& size) {
  try {
    section_area(size, "here");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SpecimenSize, HasItsSectionInOneOfThreeWays) {
  SpecimenSize area, rectangle, circle;
  area.area = "2.5e3 um^2";
  rectangle.width = 4e-3, rectangle.thickness = 5e-3;
  circle.diameter = 2e-3;
  EXPECT_DOUBLE_EQ(section_area(area, ""), 2.5e-9);
  EXPECT_DOUBLE_EQ(section_area(rectangle, ""), 20e-6);
  EXPECT_DOUBLE_EQ(section_area(circle, ""), std::numbers::pi * 1e-6);
  EXPECT_TRUE(has_section_keys(circle));
  EXPECT_FALSE(has_section_keys({}));
  rectangle.area = "1 mm^2";
  EXPECT_THAT(area_refusal(rectangle), HasSubstr("once"));
  EXPECT_THAT(area_refusal({}), HasSubstr("once"));
  for (const char* text : {"12 mm", "mm^2", "-1 mm^2", "nan mm^2", "0 mm^2", "12 N^2", "12"}) {
    area.area = text;
    EXPECT_THAT(area_refusal(area), HasSubstr("is not an area with its unit")) << text;
  }
}

TEST(SpecimenSize, IsPrintedInTheUnitThatFits) {
  EXPECT_EQ(area_text(78.54e-6), "78.54 mm^2");
  EXPECT_EQ(area_text(4.909e-10), "490.9 um^2");
}

}  // namespace
}  // namespace palpate::app
