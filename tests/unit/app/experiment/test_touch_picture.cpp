// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/touch_picture.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "app/experiment/line_of_touch.hpp"
#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

constexpr double kStiffness = 170, kDepth = 0.008;
const SlingshotSetup kOffTheAxis{VirtualBody::Cylinder, 0.01, 0.3, 2000, 0};

std::string picture_of(const SlingshotSetup& setup) {
  const samples::TemporaryFolder folder;
  write_touch_picture(folder / "touch.svg", setup, kStiffness, kDepth);
  std::ostringstream text;
  text << std::ifstream(folder / "touch.svg").rdbuf();
  return text.str();
}

long shapes_of(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  return std::distance(std::sregex_iterator(text.begin(), text.end(), expression), {});
}

/// A parallel projection shows half of a closed cylinder; one patch is the active one.
TEST(TouchPicture, ShowsTheNearHalfOfThePatchesAndTheActiveOne) {
  const std::string svg = picture_of(kOffTheAxis);
  EXPECT_NEAR(static_cast<double>(shapes_of(svg, "<polygon")), 504 / 2, 504 / 18.0);
  EXPECT_EQ(shapes_of(svg, "#f2b134"), 1);
  EXPECT_NE(svg.find("504 patches"), std::string::npos);
}

/// On the axis the force is that of the wall (34).
TEST(TouchPicture, StatesTheForce) {
  const SlingshotSetup on_the_axis{VirtualBody::Cylinder, 0, 0.3, 2000, 0};
  const double wall = slingshot::wall_force(kStiffness, kDepth);
  EXPECT_NE(picture_of(on_the_axis).find(fmt::format("{:.2f} N</text>", wall)), std::string::npos);
}

TEST(TouchPicture, IsRefusedWhereItCannotBeWritten) {
  EXPECT_THROW(write_touch_picture("/no/such/folder/a.svg", kOffTheAxis, kStiffness, kDepth),
               Error);
}

}  // namespace
}  // namespace palpate::app
