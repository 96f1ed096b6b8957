// SPDX-License-Identifier: AGPL-3.0-or-later
// What is drawn of a body: what lies beside its library.
#include "app/play/drawn.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/app/report/synthetic.hpp"

namespace palpate::app {
namespace {

Library three_vertices() {
  Library library;
  library.positions = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}};
  return library;
}

TEST(DrawnBody, IsNoneWhereNothingLiesBesideTheLibrary) {
  const samples::TemporaryFolder folder;
  const DrawnBody drawn = drawn_body(folder.path() / "gel.plib", three_vertices());
  EXPECT_FALSE(drawn.body);
  EXPECT_TRUE(drawn.triangles.empty());
}

TEST(DrawnBody, IsTheSurfaceOfThatName) {
  const samples::TemporaryFolder folder;
  std::ofstream(folder.path() / "gel.off") << "OFF\n3 1 0\n0 0 0\n0.01 0 0\n0 0.01 0\n3 0 1 2\n";
  const DrawnBody drawn = drawn_body(folder.path() / "gel.plib", three_vertices());
  EXPECT_EQ(drawn.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(DrawnBody, HasWhatElseIsOfThatName) {
  const samples::TemporaryFolder folder;
  std::ofstream(folder.path() / "gel.off") << "OFF\n3 1 0\n0 0 0\n0.01 0 0\n0 0.01 0\n3 0 1 2\n";
  const char* inner = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n";
  for (const char* name : {"gel.vessel.off", "gel.nodule.off", "gelatine.off", "other.nodule.off"})
    std::ofstream(folder.path() / name) << inner;
  std::ofstream(folder.path() / "gel.pdef") << "bytes";
  const DrawnBody drawn = drawn_body(folder.path() / "gel.plib", three_vertices());
  EXPECT_EQ(drawn.deformation, "bytes");
  ASSERT_EQ(drawn.inclusions.size(), 2U);
  EXPECT_EQ(drawn.inclusions[0].region, "nodule");
  EXPECT_EQ(drawn.inclusions[1].region, "vessel");
  EXPECT_EQ(drawn.inclusions[0].points.size(), 4U);
  EXPECT_EQ(drawn.inclusions[0].facets, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}}));
}

TEST(DrawnBody, RefusesASurfaceOfAnotherLibraryAndFacesThatAreNoTriangles) {
  const samples::TemporaryFolder folder;
  for (const char* text :
       {"OFF\n3 1 0\n0 0 0\n0.01 0 0\n0 0.011 0\n3 0 1 2\n", "OFF\n2 0 0\n0 0 0\n0.01 0 0\n",
        "OFF\n3 1 0\n0 0 0\n0.01 0 0\n0 0.01 0\n2 0 1\n"}) {
    std::ofstream(folder.path() / "gel.off") << text;
    EXPECT_THROW(drawn_body(folder.path() / "gel.plib", three_vertices()), Error) << text;
  }
}

TEST(DrawnBody, IsTheBodyOfTheFolderOfACase) {
  const samples::TemporaryFolder folder;
  const auto all = testing::synthetic(1, 1);
  write_body(folder.path() / "body.h5", all.body);
  std::ofstream(folder.path() / "deformation.pdef") << "bytes";
  const DrawnBody drawn = drawn_body(folder.path() / "library.h5", all.library);
  EXPECT_EQ(drawn.deformation, "bytes");
  ASSERT_TRUE(drawn.body);
  EXPECT_EQ(drawn.body->nodes, all.body.nodes);
  // A library of another name in that folder may be of any body.
  EXPECT_FALSE(drawn_body(folder.path() / "gel.plib", all.library).body);
  EXPECT_TRUE(drawn_body(folder.path() / "gel.plib", all.library).deformation.empty());
}

}  // namespace
}  // namespace palpate::app
