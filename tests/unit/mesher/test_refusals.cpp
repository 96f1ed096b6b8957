// SPDX-License-Identifier: AGPL-3.0-or-later
// Every reason for which a surface or a plan is refused: the kind, the place, the problem with its
// figures, and that a remedy is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "format/error.hpp"
#include "mesher/mesher.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using test::off_text;
using test::TemporaryFile;
using testing::HasSubstr;

Settings settings_for(const std::filesystem::path& path, double unit = 1) {
  Settings s;
  s.surface = {path, unit, ""};
  s.supports = {PlaneSupport{{0, 0, 1e-3}, {0, 0, -1}}};
  s.patch_spacing = 0.010;
  s.element_size = 0.010;
  return s;
}

void expect_refused(const Settings& settings, const std::string& where, const std::string& problem,
                    const std::string& remedy, ErrorKind kind = ErrorKind::Geometry) {
  try {
    mesh(settings);
    FAIL() << "accepted, expected: " << problem;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_THAT(error.where(), HasSubstr(where));
    EXPECT_THAT(error.problem(), HasSubstr(problem));
    EXPECT_THAT(error.remedy(), HasSubstr(remedy));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

void expect_file_refused(const std::string& name, const std::string& content,
                         const std::string& problem, const std::string& remedy) {
  const TemporaryFile file(name, content);
  expect_refused(settings_for(file.path()), name, problem, remedy);
}

Surface cube() {
  return test::box({0, 0, 0}, {0.05, 0.05, 0.05});
}

TEST(Refusals, FileThatIsNotThereOrCannotBeRead) {
  expect_refused(settings_for("nowhere/liver.stl"), "nowhere/liver.stl", "no such file", "path");
  expect_refused(settings_for(std::filesystem::temp_directory_path()), "", "not a readable file",
                 "permissions");
  expect_file_refused("a.vtp", "x", "unknown kind of surface file '.vtp'", "convert");
  expect_file_refused("empty.off", "", "empty or cannot be read", "export");
  expect_file_refused("empty.obj", "# nothing\n", "no faces", "export");
  testing::internal::CaptureStderr();
  expect_file_refused("prose.ply", "once upon a time", "empty or cannot be read", "export");
  expect_file_refused("header.ply", "ply\nonce upon a time\n", "empty or cannot be read", "export");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // the error is the one line there is
  std::string cut = off_text(cube());
  cut.resize(cut.size() - 20);
  expect_file_refused("cut.off", cut, "malformed", "export");
}

TEST(Refusals, NumbersThatAreNotFiniteOrMissing) {
  expect_file_refused("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n",
                      "1 point with a coordinate that is not finite (NaN or Inf), number 3 of",
                      "coordinates");
  expect_file_refused("nans.obj", "v 0 0 0\nv 1 inf 0\nv 0 nan 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n",
                      "2 points with a coordinate that is not finite (NaN or Inf), the first of "
                      "them number 2 of",
                      "coordinates");
  const TemporaryFile inf("inf.off", "OFF\n3 1 0\n0 0 0\n1 -INF inf\n0 nan 0\n3 0 1 2\n");
  expect_refused(settings_for(inf.path()), "inf.off:4", "not finite (NaN or Inf), in 2 lines",
                 "coordinates");
  expect_file_refused("word.obj", "v 0 0 0\nv 1 zero 0\n", "line 2: a vertex without three numbers",
                      "export");
  expect_file_refused("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 0\nf -1 -2 -4\n",
                      "3 faces with an index outside the 3 vertices", "damaged");
  expect_file_refused("range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "", "export");
  expect_file_refused("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1 2 3\n",
                      "1 face with fewer than three indices", "export");
}

TEST(Refusals, TopologyWithItsCounts) {
  Surface open = cube();
  open.triangles.pop_back();
  expect_file_refused("open.off", off_text(open), "not closed: 3 border edges", "close its holes");

  Surface fin = cube();
  fin.points.push_back({0.1, 0.1, 0.1});
  fin.triangles.push_back({1, 4, 8});
  expect_file_refused("fin.off", off_text(fin),
                      "1 edge with more than two faces (and 2 border edges)", "duplicate");

  Surface pair = cube();
  append(pair, test::box({0.1, 0, 0}, {0.15, 0.05, 0.05}));
  expect_file_refused("pair.off", off_text(pair), "2 separate parts", "one part");

  Surface pinched = cube();  // two cubes that share one corner
  Surface other = test::box({0.05, 0.05, 0.05}, {0.1, 0.1, 0.1});
  append(pinched, other);
  expect_file_refused("pinched.off", off_text(pinched), "touch only in 1 point", "separate");
}

TEST(Refusals, OneSidedSurface) {
  // A closed one-sided surface: the torus grid whose second direction is glued in reverse.
  constexpr int n = 8;
  Surface klein;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) klein.points.push_back({0.01 * i, 0.01 * j, 0.003 * (i * j % 5)});
  }
  const auto at = [](int i, int j) { return (i == n ? (n - j % n) % n : i * n + j % n); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      klein.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      klein.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  expect_file_refused("klein.off", off_text(klein), "one-sided", "encloses a volume");
}

TEST(Refusals, SelfIntersectionAndFlatTriangles) {
  Surface spiked = test::sphere({0, 0, 0}, 0.03, 24);
  spiked.points[5] = -2 * spiked.points[5];  // through the far side
  expect_file_refused("spiked.off", off_text(spiked), "the surface cuts itself", "resolve");

  Surface flat = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  flat.points.push_back({0.025, 0.025, 0});  // on the diagonal 1-2 of the bottom
  flat.triangles[0] = {0, 2, 1};
  flat.triangles[1] = {8, 2, 3};
  flat.triangles.push_back({1, 8, 3});
  flat.triangles.push_back({1, 2, 8});
  expect_file_refused("flat.off", off_text(flat), "1 triangle of zero area", "degenerate");
}

TEST(Refusals, SizeThatDoesNotFitTheUnit) {
  const TemporaryFile file("organ_mm.off", off_text(test::box({0, 0, 0}, {180, 120, 70})));
  expect_refused(settings_for(file.path(), 1.0), "organ_mm.off", "180000 mm with a unit of 1 m",
                 "'mm' looks likely");
  expect_refused(settings_for(file.path(), 1e-6), "organ_mm.off", "0.18 mm with a unit of 1e-06 m",
                 "'mm' looks likely");
}

TEST(Refusals, InclusionOutOfPlace) {
  const TemporaryFile skin("skin.off", off_text(cube()));
  const auto with = [&](const TemporaryFile& inclusion) {
    Settings s = settings_for(skin.path());
    s.inclusions = {{inclusion.path(), 1, "nodule"}};
    return s;
  };
  const TemporaryFile outside("outside.off", off_text(test::sphere({0.2, 0, 0}, 0.01, 16)));
  expect_refused(with(outside), "outside.off", "outside the skin", "unit");
  const TemporaryFile across("across.off", off_text(test::sphere({0, 0.02, 0.02}, 0.01, 16)));
  expect_refused(with(across), "across.off", "touches or cuts the skin", "move");

  const TemporaryFile inner("inner.off", off_text(test::sphere({0.025, 0.025, 0.025}, 0.005, 16)));
  const TemporaryFile outer("outer.off", off_text(test::sphere({0.025, 0.025, 0.025}, 0.015, 16)));
  const TemporaryFile beside("beside.off", off_text(test::sphere({0.03, 0.025, 0.025}, 0.005, 16)));
  Settings nested = with(outer);
  nested.inclusions.push_back({inner.path(), 1, "core"});
  expect_refused(nested, "outer.off", "contains", "nested inclusions");
  Settings crossed = with(inner);
  crossed.inclusions.push_back({beside.path(), 1, "core"});
  expect_refused(crossed, "inner.off", "touches or cuts", "apart");
}

TEST(Refusals, SupportsThatHoldNothingOrEverything) {
  const TemporaryFile file("held.off", off_text(cube()));
  Settings s = settings_for(file.path());
  s.supports.clear();
  expect_refused(s, "held.off", "the body would float", "(0, 0, 0) mm to (50, 50, 50) mm");
  s.supports = {SphereSupport{{1, 1, 1}, 0.01}};
  expect_refused(s, "held.off", "hold 0 of", "place a support");
  s.supports = {BoxSupport{{-1, -1, -1}, {1, 0, 0}}};  // one edge: the body could still turn
  expect_refused(s, "held.off", "the body would float", "place a support");
  const BoxSupport base{{-1, -1, -1}, {1, 1, 0}};
  s.supports.clear();
  s.foundation = {{base, 1e6, 0}};  // springs along one direction only: it could still slide
  expect_refused(s, "held.off", "on springs, the body would float", "tangential_stiffness");
  s.foundation = {{SphereSupport{{1, 1, 1}, 0.01}, 1e6, 1e6}};
  expect_refused(s, "held.off", "hold no facet", "place them on the body");
  s.foundation = {{base, 0, 0}};
  expect_refused(s, "mesh", "springs of 0", "one of them positive", ErrorKind::Configuration);
  s.foundation.clear();
  s.supports = {BoxSupport{{-1, -1, -1}, {1, 1, 1}}};
  expect_refused(s, "held.off", "nothing can be touched", "smaller");
  s.supports = {base};
  s.tool_radius = 0.09;  // of a tool that would rest on the support from everywhere
  expect_refused(s, "held.off", "the radius of the tool, 90 mm", "tool smaller");
}

TEST(Refusals, NamesThatNoFaceBears) {
  const TemporaryFile file("unnamed.off", off_text(cube()));
  Settings s = settings_for(file.path());
  s.supports = {LabelSupport{"bone"}};
  expect_refused(s, "unnamed.off", "no face bears the name 'bone'", "in an OBJ file",
                 ErrorKind::Configuration);
  const TemporaryFile named("named.obj",
                            "v 0 0 0\nv 0.05 0 0\nv 0 0.05 0\nv 0 0 0.05\ng skin\nf 1 3 2\nf 1 2 "
                            "4\ng bed # below\nf 2 3 4\nf 3 1 4\n");
  s.surface.path = named.path();
  expect_refused(s, "named.obj", "no face bears the name 'bone'", "use one of bed, skin",
                 ErrorKind::Configuration);
}

TEST(Refusals, DepthBeyondTheThickness) {
  const TemporaryFile file("plate.off", off_text(test::box({0, 0, 0}, {0.06, 0.06, 0.005})));
  Settings s = settings_for(file.path());
  s.patch_spacing = s.element_size = 0.005;
  s.depth = 0.0045;
  expect_refused(s, "plate.off", "only 5 mm at (", "below 4 mm");
  s.depth = 0.0039;
  EXPECT_NO_THROW(mesh(s));
}

TEST(Refusals, DragsLongerThanTheBody) {
  const TemporaryFile file("short.off", off_text(cube()));
  Settings s = settings_for(file.path());
  s.lateral_travel = 0.0501;
  expect_refused(s, "short.off", "50.1 mm is longer than the body, 50 mm", "reduce lateral_travel");
  s.lateral_travel = 0.05;
  EXPECT_NO_THROW(mesh(s));
}

TEST(Refusals, PatchesCoarserThanTheDetail) {
  // A thin shell: two walls 2 mm apart cannot be told apart by patches of 30 mm.
  const TemporaryFile file("shell.off", off_text([] {
                             Surface bowl = test::sphere({0, 0, 0}, 0.05, 64);
                             for (Vec3& x : bowl.points) {
                               if (x[2] > 0)
                                 x = Vec3{0.96 * x[0], 0.96 * x[1], 0.002 - 0.96 * x[2]};
                             }
                             return bowl;
                           }()));
  Settings s = settings_for(file.path());
  s.patch_spacing = s.element_size = 0.03;
  expect_refused(s, "shell.off", "remeshing", "reduce the spacing");
}

TEST(Refusals, SettingsThatMakeNoSense) {
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
  expect(with([](Settings& s) { s.interior_growth = 0.5; }), "interior_growth is 0.5");
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

}  // namespace
}  // namespace palpate::mesher
