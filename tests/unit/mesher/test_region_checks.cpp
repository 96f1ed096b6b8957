// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "format/error.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/mesher.hpp"
#include "mesher/region_checks.hpp"
#include "tests/unit/mesher/body_checks.hpp"
#include "tests/unit/mesher/refusals.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using test::box;
using test::cube;
using test::expect_refused;
using test::off_text;
using test::settings_for;
using test::sphere;
using test::TemporaryFile;
using testing::HasSubstr;
using testing::Not;

Surface scaled(Surface surface, double factor) {
  for (Vec3& x : surface.points) x = factor * x;
  return surface;
}

/// The cube of 50 mm with one inclusion.
class RegionChecks : public testing::Test {
 protected:
  Settings with(const TemporaryFile& inclusion, double unit) const {
    Settings s = settings_for(skin_.path());
    s.inclusions = {{inclusion.path(), unit, "nodule"}};
    return s;
  }
  static std::string remedy_of(const Settings& settings) {
    try {
      mesh(settings);
    } catch (const Error& error) {
      return error.remedy();
    }
    return "accepted";
  }

 private:
  TemporaryFile skin_{"skin.off", off_text(cube())};
};

/// A nodule of 16 mm whose numbers are centimetres, millimetres or inches.
TEST_F(RegionChecks, NameTheUnitInWhichANoduleFits) {
  const Surface nodule = sphere({0.025, 0.025, 0.025}, 0.008, 16);
  const TemporaryFile mm("mm.off", off_text(scaled(nodule, 1e3)));
  const TemporaryFile cm("cm.off", off_text(scaled(nodule, 1e2)));
  expect_refused(with(mm, 0.01), "mm.off",
                 "outside the body: it is 160 x 160 x 160 mm, from (170, 170, 170)",
                 "unit = \"mm\"");
  EXPECT_THAT(remedy_of(with(mm, 0.01)), HasSubstr("16 x 16 x 16 mm inside the bounds"));
  expect_refused(with(cm, 1), "cm.off", "the body is 50 x 50 x 50 mm", "unit = \"cm\"");
  EXPECT_NO_THROW(mesh(with(mm, 0.001)));
}

/// About the origin of the file nothing lies apart: the size alone tells.
TEST_F(RegionChecks, NameTheUnitOfAnInclusionLargerThanTheBody) {
  const TemporaryFile skin("round.off", off_text(sphere({}, 0.05, 40)));
  const TemporaryFile mm("mm.off", off_text(sphere({}, 20, 16)));
  Settings s = with(mm, 0.01);
  s.surface.path = skin.path();
  s.supports = {PlaneSupport{{0, 0, -0.03}, {0, 0, -1}}};
  expect_refused(s, "mm.off", "larger than the body in every direction: it is 400 x 400 x 400 mm",
                 "unit = \"mm\"");
  s.inclusions.front().unit = 0.001;
  EXPECT_NO_THROW(mesh(s));
}

TEST_F(RegionChecks, ProposeNoUnitWhereNoneFits) {
  const TemporaryFile apart("apart.off", off_text(sphere({-0.2, 0, 0}, 0.01, 16)));
  EXPECT_THAT(remedy_of(with(apart, 1)), HasSubstr("same coordinates"));
  EXPECT_THAT(remedy_of(with(apart, 1)), Not(HasSubstr("unit =")));
}

TEST_F(RegionChecks, RefuseInclusionsThatLeaveNothingOfTheBody) {
  const TemporaryFile around("around.off", off_text(sphere({0.025, 0.025, 0.025}, 0.06, 40)));
  expect_refused(with(around, 1), "around.off", "encloses the whole body", "check the units");
  const TemporaryFile same("same.off", off_text(cube()));
  expect_refused(with(same, 1), "same.off", "encloses the whole body", "remove");
  const TemporaryFile left("left.off", off_text(box({-0.01, -0.01, -0.01}, {0.025, 0.06, 0.06})));
  const TemporaryFile right("right.off", off_text(box({0.02, -0.01, -0.01}, {0.06, 0.06, 0.06})));
  Settings both = with(left, 1);
  both.inclusions.push_back({right.path(), 1, "other"});
  expect_refused(both, "skin.off", "the inclusions fill the whole body", "sizes and units");
}

/// What lies outside the body is cut off, however large it is.
TEST_F(RegionChecks, TakeALargeInclusionThatCutsTheBody) {
  const TemporaryFile half("half.off", off_text(box({0.025, -0.3, -0.3}, {0.6, 0.3, 0.3})));
  const Body body = mesh(with(half, 1));
  EXPECT_NEAR(test::volume_of_region(body, 1), 0.5 * 0.05 * 0.05 * 0.05, 0.02 * 1.25e-4);
}

/// The warnings of the sizes of layers and inclusions in the cube.
std::string warnings_of(Settings settings, const std::vector<Surface>& inclusions = {}) {
  std::string warnings;
  settings.log = [&](std::string_view line) {
    if (line.starts_with(kWarningMark)) warnings += std::string(line) + "\n";
  };
  check_thinness(settings, cube(), inclusions);
  return warnings;
}

/// Walls of 2 x 150 cm^2 of triangles as long as the layer is thick, of which two share a node.
TEST_F(RegionChecks, RefuseALayerThatNeedsMoreNodesThanAMeshMayHave) {
  const TemporaryFile skin("thin.off", off_text(cube()));
  Settings s = settings_for(skin.path());
  s.layers = {{0.00002, "epidermis"}};
  expect_refused(s, "thin.off", "the layer 'epidermis' is 0.02 mm thick, element_size 10 mm",
                 "thicker than 0.13 mm", ErrorKind::Configuration);
}

/// As many nodes as it says, by the mesh itself.
TEST_F(RegionChecks, WarnOfAThinLayerAndOfTheNodesThatItTakes) {
  const TemporaryFile skin("layered.off", off_text(cube()));
  Settings s = settings_for(skin.path());
  s.layers = {{0.002, "skin"}};
  std::string warnings;
  s.log = [&](std::string_view line) {
    if (line.starts_with(kWarningMark)) warnings += std::string(line);
  };
  const Body body = mesh(s);
  std::smatch found;
  ASSERT_TRUE(std::regex_search(warnings, found, std::regex("take about (\\d+) nodes")))
      << warnings;
  EXPECT_NEAR(std::log2(std::stod(found[1]) / static_cast<double>(body.nodes.size())), 0, 1);
  EXPECT_THAT(warnings, HasSubstr("thicker than 2.5 mm"));
  s.layers = {{0.004, "skin"}, {0.006, "fat"}};
  EXPECT_EQ(warnings_of(s), "");
}

TEST_F(RegionChecks, WarnOfThinInclusionsAndRefuseThoseOfTooManyNodes) {
  Settings s = settings_for("skin.off");
  s.inclusions = {{"sheet.off", 1, "fascia"}};
  const auto sheet = [](double thickness) {
    return box({0.01, 0.01, 0.02}, {0.04, 0.04, 0.02 + thickness});
  };
  EXPECT_EQ(warnings_of(s, {sheet(0.005)}), "");
  EXPECT_THAT(warnings_of(s, {sheet(0.001)}), HasSubstr("the inclusion sheet.off is "));
  EXPECT_THAT(warnings_of(s, {sheet(0.001)}),
              HasSubstr("meshing and campaign take as much longer"));
  EXPECT_THROW(check_thinness(s, cube(), {sheet(0.00001)}), Error);
  const Surface rod = box({0.01, 0.025, 0.025}, {0.016, 0.026, 0.026});
  EXPECT_THAT(warnings_of(s, {rod}), HasSubstr("lost between the elements"));
  EXPECT_EQ(warnings_of(s, {sphere({0.025, 0.025, 0.025}, 0.006, 16)}), "");
}

}  // namespace
}  // namespace palpate::mesher
