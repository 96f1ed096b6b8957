// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/read_off.hpp"

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

TEST(ReadOff, HasPointsAndPolygons) {
  const Soup soup =
      read_off("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0.5\n0 1e-1 -2\n3 0 1 2\n4 0 1 2 3\n", "a.off");
  EXPECT_EQ(soup.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 0.1, -2}}));
  EXPECT_EQ(soup.polygons, (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {0, 1, 2, 3}}));
}

TEST(ReadOff, SkipsCommentsColoursAndTheNumberOfEdges) {
  const Soup soup = read_off(
      "# a mesh\nCOFF 3 1 # no edges\n0 0 0 255 0 0 255\n# between\n1 0 0 0 255 0 255\n"
      "0 1 0 0 0 255 255\n3 0 1 2 0.5 0.5 0.5\n",
      "a.off");
  EXPECT_EQ(soup.points.size(), 3U);
  EXPECT_EQ(soup.polygons, (std::vector<std::vector<std::size_t>>{{0, 1, 2}}));
}

TEST(ReadOff, TakesWhateverFollowsTheCoordinates) {
  // Colours, normals and texture coordinates in every combination that the heading can name.
  for (const std::string kind :
       {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"}) {
    const Soup soup =
        read_off(kind + "\n3 1 0\n0 0 0 9 9\n1 0 0 9 9\n0 1 0 9 9\n3 0 1 2\n", "a.off");
    EXPECT_EQ(soup.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << kind;
  }
}

TEST(ReadOff, AFaceMayBeSpreadOverLines) {
  const Soup soup =
      read_off("OFF\n3 2 0\n0 0 0\n1 0\n0\n0 1 0\n3 0 \n1 \n2 \n\n3 2\n1\n0\n", "a.off");
  EXPECT_EQ(soup.polygons, (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {2, 1, 0}}));
}

TEST(ReadOff, NamesTheLineOfAFault) {
  const auto read = [](const std::string& bytes) { return [=] { read_off(bytes, "a.off"); }; };
  expect_refusal(read("once upon a time"), "a.off:1", "does not begin with 'OFF'");
  expect_refusal(read("OFF BINARY\n"), "a.off:1", "binary", "as text");
  expect_refusal(read("OFF\n3 1 0\n0 0 0\n# one more\n1 zero 0\n0 1 0\n3 0 1 2\n"), "a.off:5",
                 "'zero'");
  expect_refusal(read("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), "a.off:6", "the index 3");
  expect_refusal(read("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 \n\n"), "a.off", "the file ends");
  expect_refusal(read("OFF\n900000000 1 0\n0 0 0\n"), "a.off:2", "900000000");
}

}  // namespace
}  // namespace palpate::mesher
