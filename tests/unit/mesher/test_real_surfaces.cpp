// SPDX-License-Identifier: AGPL-3.0-or-later
// Surfaces others made, kept beside the checkout: broken ones are refused for the right reason,
// clean ones become sound bodies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "format/error.hpp"
#include "mesher/mesher.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/unit/mesher/body_checks.hpp"

namespace palpate::mesher {
namespace {

std::filesystem::path shared_surface(const std::string& name) {
  return palpate::test::source_folder().parent_path() / "shared/data/surfaces" / name;
}

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
  const auto path = shared_surface(GetParam().file);
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not available: " << path;
  Settings s;
  s.surface = {path, GetParam().unit, ""};
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
    Shared, BrokenSurface,
    testing::Values(
        Broken{"sofa_head.obj", 0.01, "not closed: 40 border edges"},
        Broken{"sofa_dragon.obj", 0.01, "102 edges with more than two faces"},
        Broken{"surfice_cortex_5124.obj", 0.001, "2 separate parts"},
        Broken{"trimesh_empty.stl", 0.001, "no faces"},
        Broken{"trimesh_joined_tetrahedra.obj", 0.1, "3 edges with more than two faces"},
        Broken{"trimesh_multibody.stl", 0.1, "2 separate parts"},
        Broken{"trimesh_not_convex.obj", 0.1, "12 edges with more than two faces"},
        Broken{"trimesh_notenoughindices.obj", 0.001, "1 face with fewer than three indices"},
        Broken{"trimesh_soup.stl", 0.1, "not closed: 300 border edges"},
        Broken{"sofa_pelvis_f.obj", 10, "outside 1 mm .. 10 m"}));

struct Clean {
  std::string file;
  double unit;  // m
  double patch, element;
  double held_below;  // m, height of the plane support
  int euler;          // V - E + F of its boundary: 2 - 2 genus
};

void PrintTo(const Clean& clean, std::ostream* out) {
  *out << clean.file;
}

class CleanSurface : public testing::TestWithParam<Clean> {};

TEST_P(CleanSurface, BecomesASoundBody) {
  const Clean& clean = GetParam();
  const auto path = shared_surface(clean.file);
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not available: " << path;
  Settings s;
  s.surface = {path, clean.unit, ""};
  s.patch_spacing = clean.patch;
  s.element_size = clean.element;
  s.supports = {PlaneSupport{{0, 0, clean.held_below}, {0, 0, -1}}};
  const Body body = mesh(s);
  test::expect_sound(body);
  test::expect_nested(body, static_cast<int>(std::lround(clean.patch / clean.element)));
  EXPECT_EQ(test::euler_characteristic(body), clean.euler);
}

INSTANTIATE_TEST_SUITE_P(
    Shared, CleanSurface,
    testing::Values(Clean{"sofa_liver2.obj", 0.1, 0.010, 0.005, 1.455, 2},
                    Clean{"sofa_tongue.obj", 0.02, 0.006, 0.003, -0.058, 2},
                    Clean{"sofa_pelvis_f.obj", 0.1, 0.006, 0.003, -0.006, 0},
                    Clean{"trimesh_ballA.off", 0.01, 0.010, 0.010, -0.055, 2},
                    Clean{"trimesh_nancolor.obj", 0.1, 0.010, 0.010, -0.045, 2},
                    Clean{"trimesh_negative_indices.obj", 0.05, 0.010, 0.010, -0.045, 2},
                    Clean{"trimesh_quadknot.obj", 0.001, 0.006, 0.006, -0.150, 0}));

TEST(ThinBowl, IsRefusedForADepthBeyondItsWall) {
  const auto path = shared_surface("sofa_SaladBowl.obj");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not available: " << path;
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

}  // namespace
}  // namespace palpate::mesher
