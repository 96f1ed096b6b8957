// SPDX-License-Identifier: AGPL-3.0-or-later
// Surfaces of other projects (tests/data/surfaces, data/bodies): broken ones are refused with the
// right reason, clean ones become sound bodies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "format/error.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/mesher.hpp"
#include "mesher/read/read_surface.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/unit/mesher/body_checks.hpp"

namespace palpate::mesher {
namespace {

std::filesystem::path surface(const std::string& name) {
  return palpate::test::source_folder() / "tests/data/surfaces" / name;
}

constexpr const char* kLiver = "../../../data/bodies/sofa/liver.obj";

struct Broken {
  std::string file;
  double unit;  // m
  std::string problem;
};

void PrintTo(const Broken& broken, std::ostream* out) {
  *out << broken.file;
}

class BrokenSurface : public testing::TestWithParam<Broken> {};

TEST_P(BrokenSurface, IsRefusedForItsDefect) {
  const auto path = surface(GetParam().file);
  Settings s;
  s.surface = {path, GetParam().unit, "", {RepairMode::None}};
  s.supports = {PlaneSupport{{0, 0, 0}, {0, 0, -1}}};
  try {
    mesh(s);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_EQ(error.where(), path.string());
    EXPECT_THAT(error.problem(), testing::HasSubstr(GetParam().problem));
    EXPECT_FALSE(error.remedy().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BrokenSurface,
    testing::Values(
        Broken{"sofa/head.obj", 0.01, "not watertight: 40 border edges"},
        Broken{"sofa/dragon.obj", 0.01, "102 edges with more than two faces"},
        Broken{"surfice/cortex_5124.obj", 0.001, "2 separate parts"},
        Broken{"trimesh/empty.stl", 0.001, "no faces"},
        Broken{"trimesh/joined_tetrahedra.obj", 0.1, "3 edges with more than two faces"},
        Broken{"trimesh/multibody.stl", 0.1, "2 separate parts"},
        Broken{"trimesh/not_convex.obj", 0.1, "12 edges with more than two faces"},
        Broken{"trimesh/notenoughindices.obj", 0.001, "1 face with fewer than three indices"},
        Broken{"trimesh/soup.stl", 0.1, "not watertight: 300 border edges"},
        Broken{"sofa/pelvis_f.obj", 10, "outside 0.01 mm .. 10 m"}));

TEST(FaultySurface, IsRepairedToASoundOne) {
  // Two hemispheres of a cortex that intersect themselves.
  std::string log;
  SurfaceFile file{surface("surfice/cortex_5124.obj"), 0.001, ""};
  file.repair.largest_part = true;
  const Surface cortex =
      read_surface(file, [&](std::string_view line) { log += std::string(line) + "\n"; });
  EXPECT_EQ(count_self_intersections(cortex), 0U);
  EXPECT_EQ(count_degenerate_triangles(cortex), 0U);
  EXPECT_GT(signed_volume(cortex), 0);
  EXPECT_THAT(log, testing::HasSubstr("removed 1 separate part"));
  EXPECT_THAT(log, testing::HasSubstr("the surface moved by at most"));
}

/// The surface, and what the log says of it.
Surface read_logged(const SurfaceFile& file, std::string& log) {
  Surface result =
      read_surface(file, [&](std::string_view line) { log += std::string(line) + "\n"; });
  EXPECT_EQ(count_self_intersections(result), 0U);
  EXPECT_EQ(count_degenerate_triangles(result), 0U);
  return result;
}

TEST(FaultySurface, AHeadWithoutANeckIsClosedWithWarnings) {
  constexpr double extent = 0.1334958927;  // m, of the file
  std::string log;
  const Surface head = read_logged({surface("sofa/head.obj"), 0.01, ""}, log);
  EXPECT_THAT(log, testing::ContainsRegex("warning: .*a hole of 123[0-9.]* mm at .* was filled"));
  EXPECT_THAT(log, testing::ContainsRegex("warning: .*local repairs move the surface by 1.35"));
  EXPECT_NEAR(largest_dimension(head.points), extent, 1e-3 * extent);
}

TEST(FaultySurface, ADragonThatCrossesItselfIsWrapped) {
  constexpr double extent = 0.228649;  // m, of its largest part
  std::string log;
  const Surface dragon =
      read_logged({surface("sofa/dragon.obj"), 0.01, "", {.largest_part = true}}, log);
  EXPECT_THAT(log, testing::ContainsRegex("warning: .*the surface self-intersects"));
  EXPECT_THAT(log, testing::HasSubstr("its alpha wrap replaces it"));
  // The offset of the wrap is 1/1500 of the extent.
  EXPECT_NEAR(largest_dimension(dragon.points), extent, 0.002 * extent);
}

struct Clean {
  std::string file;
  double unit;  // m
  double patch, element;
  double fixed_below;  // m, height of the plane support
  int euler;           // V - E + F of its boundary: 2 - 2 genus
};

void PrintTo(const Clean& clean, std::ostream* out) {
  *out << std::filesystem::path(clean.file).filename().string();
}

class CleanSurface : public testing::TestWithParam<Clean> {};

TEST_P(CleanSurface, BecomesASoundBody) {
  const Clean& clean = GetParam();
  const auto path = surface(clean.file);
  Settings s;
  s.surface = {path, clean.unit, ""};
  s.patch_spacing = clean.patch;
  s.element_size = clean.element;
  s.supports = {PlaneSupport{{0, 0, clean.fixed_below}, {0, 0, -1}}};
  const Body body = mesh(s);
  test::expect_sound(body);
  test::expect_nested(body, static_cast<int>(std::lround(clean.patch / clean.element)));
  EXPECT_EQ(test::euler_characteristic(body), clean.euler);
}

INSTANTIATE_TEST_SUITE_P(
    Files, CleanSurface,
    testing::Values(Clean{kLiver, 0.1, 0.010, 0.005, 1.455, 2},
                    Clean{"sofa/tongue.obj", 0.02, 0.006, 0.003, -0.058, 2},
                    Clean{"sofa/pelvis_f.obj", 0.1, 0.006, 0.003, -0.006, 0},
                    Clean{"trimesh/ball_a.off", 0.01, 0.010, 0.010, -0.055, 2},
                    Clean{"trimesh/nancolor.obj", 0.1, 0.010, 0.010, -0.045, 2},
                    Clean{"trimesh/negative_indices.obj", 0.05, 0.010, 0.010, -0.045, 2},
                    Clean{"trimesh/quadknot.obj", 0.001, 0.006, 0.006, -0.150, 0}));

TEST(ThinBowl, IsRefusedForADepthBeyondItsWall) {
  const auto path = surface("sofa/salad_bowl.obj");
  Settings s;
  s.surface = {path, 0.4, ""};  // 250 mm wide, its wall about 6 mm
  s.supports = {PlaneSupport{{0, 0, 0.01}, {0, 0, -1}}};
  s.patch_spacing = s.element_size = 0.008;
  s.depth = 0.010;
  try {
    mesh(s);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.problem(), testing::HasSubstr("a depth of 10 mm is more than 0.8 of the"));
    EXPECT_THAT(error.remedy(), testing::HasSubstr("reduce the depth below"));
  }
}

// TetGen leaves a tetrahedron without volume under the facets of this surface at this spacing:
// Delaunay refinement makes the body.
TEST(Aneurysm, IsMeshedTheSecondWayWhereTheFirstLeavesADegenerateTetrahedron) {
  std::string log;
  Settings s;
  s.surface = {surface("sofa/aneurysm3d_1.off"), 0.01, ""};
  s.supports = {PlaneSupport{{0, 0, -0.132661}, {0, 0, -1}}};
  s.patch_spacing = s.element_size = 0.013833;
  s.tool_radius = 0.0166;
  s.log = [&](std::string_view line) { log += std::string(line) + "\n"; };
  const Body body = mesh(s);
  test::expect_sound(body);
  EXPECT_THAT(log,
              testing::ContainsRegex("isotropic remeshing does not make a sound mesh.*degenerate"));
  const double enclosed = signed_volume(read_surface(s.surface, {}));
  EXPECT_NEAR(test::boundary_volume(body), enclosed, 0.03 * enclosed);
}

}  // namespace
}  // namespace palpate::mesher
