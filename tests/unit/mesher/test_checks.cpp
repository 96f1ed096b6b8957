// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "format/error.hpp"
#include "mesher/checks.hpp"
#include "mesher/mesher.hpp"
#include "mesher/volume/discretization.hpp"
#include "tests/unit/mesher/refusals.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using test::cube;
using test::expect_refused;
using test::off_text;
using test::settings_for;
using test::TemporaryFile;

TEST(Checks, RefuseADepthBeyondTheThickness) {
  const TemporaryFile file("plate.off", off_text(test::box({0, 0, 0}, {0.06, 0.06, 0.005})));
  Settings s = settings_for(file.path());
  s.patch_spacing = s.element_size = 0.005;
  s.depth = 0.0045;
  expect_refused(s, "plate.off", "the thickness is 5 mm at (", "below 4 mm");
  s.depth = 0.0039;
  EXPECT_NO_THROW(mesh(s));
}

TEST(Checks, RefuseLateralTravelLongerThanTheBody) {
  const TemporaryFile file("short.off", off_text(cube()));
  Settings s = settings_for(file.path());
  s.lateral_travel = 0.0501;
  expect_refused(s, "short.off", "50.1 mm is longer than the body, 50 mm", "reduce lateral_travel");
  s.lateral_travel = 0.05;
  EXPECT_NO_THROW(mesh(s));
}

TEST(Checks, RefuseSettingsOutOfRange) {
  const TemporaryFile file("sense.off", off_text(cube()));
  const auto with = [&](auto change) {
    Settings s = settings_for(file.path());
    change(s);
    return s;
  };
  const auto nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [&](const Settings& s, const std::string& problem) {
    expect_refused(s, "mesh", problem, "", ErrorKind::Configuration);
  };
  expect(with([](Settings& s) { s.patch_spacing = 0; }), "patch_spacing");
  expect(with([&](Settings& s) { s.element_size = nan; }), "element_size");
  expect(with([](Settings& s) { s.support_coarsening = 0.5; }), "support_coarsening is 0.5");
  expect(with([](Settings& s) { s.interior_coarsening = 0.5; }), "interior_coarsening is 0.5");
  expect(with([](Settings& s) { s.feature_angle = -3; }), "feature_angle is -3");
  expect(with([](Settings& s) { s.depth = -0.001; }), "depth");
  expect(with([&](Settings& s) { s.lateral_travel = nan; }), "lateral_travel");
  expect(with([](Settings& s) { s.tool_radius = 0; }), "tool_radius");
  expect(with([](Settings& s) { s.surface.unit = 0; }), "unit");
  expect(with([](Settings& s) { s.supports = {PlaneSupport{}}; }), "normal");
  expect(with([](Settings& s) { s.supports = {SurfaceSupport{s.surface, -0.001}}; }), "distance");
  expect(with([](Settings& s) {
           s.supports = {SurfaceSupport{{"bone.off", 0, ""}, 0.001}};
         }),
         "unit");
  const Settings tiny = with([](Settings& s) { s.element_size = 1e-5; });
  expect_refused(tiny, "sense.off", "0.01 mm needs about", "increase element_size",
                 ErrorKind::Configuration);
}

TEST(Checks, RefuseDegenerateTetrahedraAndNameTheirPlace) {
  VolumeMesh mesh;
  mesh.nodes = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.002, 0.002, 1e-9}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  EXPECT_NO_THROW(check_elements(mesh, "organ.off"));
  mesh.nodes[3][2] = 1e-12;
  try {
    check_elements(mesh, "organ.off");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_EQ(error.where(), "organ.off");
    EXPECT_THAT(error.problem(), testing::HasSubstr("a tetrahedron near (3, 3, "));
    EXPECT_THAT(error.problem(), testing::HasSubstr("is degenerate"));
    EXPECT_THAT(error.remedy(), testing::HasSubstr("change patch_spacing or element_size"));
  }
  mesh.nodes[3][2] = -0.001;  // inverted
  EXPECT_THROW(check_elements(mesh, "organ.off"), Error);
}

TEST(Checks, RefuseTetrahedraThatDoNotFillTheBoundary) {
  VolumeMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  Surface boundary{mesh.nodes, boundary_of(mesh, "tetrahedron"), {}, {}};
  EXPECT_NO_THROW(check_filled(mesh, boundary, "tetrahedron"));
  boundary.points[3][2] = 1.001;
  EXPECT_THROW(check_filled(mesh, boundary, "tetrahedron"), Error);
}

}  // namespace
}  // namespace palpate::mesher
