// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "mesher/read/read_surface.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/unit/mesher/refusals.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using test::cube;
using test::expect_file_refused;
using test::expect_refused;
using test::off_text;
using test::settings_for;
using test::TemporaryFile;

TEST(ReadSurface, TheFourFormatsGiveTheSameCube) {
  const Surface cube = test::box({0, 0, 0}, {0.05, 0.04, 0.03});
  std::string obj = "# cube\nmtllib none\nweird_keyword 1 2\n";
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty "
      "double z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n";
  std::string stl = "solid cube\n";
  const auto words = [](const Vec3& x) { return text(x[0], " ", x[1], " ", x[2], "\n"); };
  for (const Vec3& x : cube.points) {
    obj += "v " + words(x);
    ply += words(x);
  }
  for (const Triangle& t : cube.triangles) {
    obj += text("f ", t[0] + 1, "/1 ", t[1] - 8, "// ", t[2] + 1, "//3\n");
    ply += text("3 ", t[0], " ", t[1], " ", t[2], "\n");
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t v : t)
      stl += "vertex " + words(cube.points[static_cast<std::size_t>(v)]);
    stl += "endloop\nendfacet\n";
  }
  stl += "endsolid cube\n";
  const TemporaryFile files[] = {
      {"cube.off", off_text(cube)}, {"cube.obj", obj}, {"cube.ply", ply}, {"cube.stl", stl}};
  for (const TemporaryFile& file : files) {
    const Surface read = read_surface({file.path(), 1, ""}, {});
    EXPECT_EQ(read.points.size(), 8U) << file.path();
    EXPECT_EQ(read.triangles.size(), 12U) << file.path();
    EXPECT_NEAR(signed_volume(read), 0.05 * 0.04 * 0.03, 1e-12) << file.path();
  }
}

TEST(ReadSurface, SidesOfAVtkBoxAreLabels) {
  for (const char* name :
       {"box_ascii.vtp", "box_appended_zlib.vtp", "box_4.vtk", "box_5_binary.vtk"}) {
    SCOPED_TRACE(name);
    const auto path = palpate::test::source_folder() / "tests/data/meshes/vtk" / name;
    const Surface read = read_surface({path, 1e-3, ""}, {});
    EXPECT_NEAR(signed_volume(read), 24e-6, 1e-12);
    EXPECT_EQ(read.points.size(), 8U);
    ASSERT_EQ(read.names.size(), 12U);
    std::map<std::string, int> faces;
    for (const std::size_t n : read.names) ++faces[read.known_names[n].at(0)];
    EXPECT_EQ(faces.size(), 6U);
    EXPECT_EQ(faces["side=5"], 2);
  }
}

TEST(ReadSurface, OrientsFacesOutwardAndLogsIt) {
  Surface inverted = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  for (Triangle& t : inverted.triangles) std::swap(t[0], t[1]);
  Surface mixed = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  for (std::size_t t = 0; t < 3; ++t) std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  const TemporaryFile a("inverted.off", off_text(inverted)), b("mixed.off", off_text(mixed));
  std::string log;
  const Log collect = [&](std::string_view line) { log += std::string(line) + "\n"; };
  EXPECT_NEAR(signed_volume(read_surface({a.path(), 1, ""}, collect)), 1.25e-4, 1e-15);
  EXPECT_THAT(log, testing::HasSubstr("oriented inward"));
  log.clear();
  EXPECT_NEAR(signed_volume(read_surface({b.path(), 1, ""}, collect)), 1.25e-4, 1e-15);
  EXPECT_THAT(log, testing::HasSubstr("reoriented 3 faces"));
}

TEST(ReadSurface, QuadsBecomeTrianglesOfTheSameVolume) {
  const TemporaryFile file(
      "quads.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const Surface read = read_surface({file.path(), 0.1, ""}, {});
  EXPECT_EQ(read.triangles.size(), 12U);
  EXPECT_NEAR(signed_volume(read), 1e-3, 1e-15);
}

TEST(ReadSurface, RefusesFilesThatAreMissingOrUnreadable) {
  expect_refused(settings_for("nowhere/liver.stl"), "nowhere/liver.stl", "no such file", "path",
                 ErrorKind::Configuration);
  expect_refused(settings_for(std::filesystem::temp_directory_path()), "", "not a readable file",
                 "permissions", ErrorKind::Configuration);
  // Each kind that the remedy names is read as that kind.
  for (const char* kind : {".off", ".obj", ".ply", ".stl", ".vtp", ".vtu", ".vtk"})
    expect_file_refused("a.3ds", "x", "unknown kind of surface file '.3ds'", kind);
  expect_file_refused("a.stl.gz", "x", "a compressed surface file is not read", "gunzip");
  expect_file_refused("skin", "x", "its name has no ending", ".vtk");
  expect_file_refused("empty.off", "", "the file is empty", "export");
  expect_file_refused("empty.obj", "# nothing\n", "no faces", "export");
  testing::internal::CaptureStderr();
  expect_file_refused("prose.ply", "once upon a time", "does not begin with 'ply'", "export");
  expect_file_refused("header.ply", "ply\nonce upon a time\n", "ends where 'end_header'", "export");
  std::string half_an_stl(154, '\0');  // 80 bytes, the number of facets, and a facet and a half
  half_an_stl[80] = 12;
  expect_file_refused("half.stl", half_an_stl, "malformed after", "export");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // the error is the only line
  std::string cut = off_text(cube());
  cut.resize(cut.size() - 20);
  expect_file_refused("cut.off", cut, "bytes that follow can hold", "export");
}

TEST(ReadSurface, NamesTheLineOfANumberThatIsNotFinite) {
  const TemporaryFile inf("inf.off", "OFF\n3 1 0\n0 0 0\n1 -INF inf\n0 nan 0\n3 0 1 2\n");
  expect_refused(settings_for(inf.path()), "inf.off:4", "a coordinate that is not finite (-INF)",
                 "correct the number");
  expect_file_refused("range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "the index 7",
                      "export");
}

TEST(ReadSurface, RefusesSelfIntersectionsAndTrianglesWithoutArea) {
  Surface spiked = test::sphere({0, 0, 0}, 0.03, 24);
  spiked.points[5] = -2 * spiked.points[5];  // through the far side
  expect_file_refused("spiked.off", off_text(spiked), "the surface self-intersects: ", "resolve");

  Surface flat = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  flat.points.push_back({0.025, 0.025, 0});  // on the diagonal 1-2 of the bottom
  flat.triangles[0] = {0, 2, 1};
  flat.triangles[1] = {8, 2, 3};
  flat.triangles.push_back({1, 8, 3});
  flat.triangles.push_back({1, 2, 8});
  expect_file_refused("flat.off", off_text(flat), "1 triangle of zero area", "degenerate");
}

TEST(ReadSurface, RefusesSizesThatDoNotFitTheUnit) {
  const TemporaryFile file("organ_mm.off", off_text(test::box({0, 0, 0}, {180, 120, 70})));
  expect_refused(settings_for(file.path(), 1.0), "organ_mm.off", "180000 mm with a unit of 1 m",
                 "'mm' looks likely");
  std::string log;
  EXPECT_NEAR(signed_volume(read_surface({file.path(), 1e-6, ""},
                                         [&](std::string_view line) { log += line; })),
              180e-6 * 120e-6 * 70e-6, 1e-20);
  EXPECT_THAT(log, testing::HasSubstr("0.18 mm with a unit of 1e-06 m, unusual"));
}

}  // namespace
}  // namespace palpate::mesher
