// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/read_obj.hpp"

#include <fstream>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

class ReadObj : public testing::Test {
 protected:
  Soup read(const std::string& content) const {
    std::ofstream(folder_ / "a.obj") << content;
    return read_obj(folder_ / "a.obj");
  }

 private:
  const samples::TemporaryFolder folder_;
};

TEST_F(ReadObj, KeepsTheNamesOfObjectGroupsAndMaterial) {
  const Soup soup = read(
      "o organ\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng top # lid\nf 1 2 3\nusemtl glue\nf 1 2 "
      "\\\n4\n"
      "g top\nf -1 -2 -3\n");
  EXPECT_EQ(soup.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(soup.polygons,
            (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {0, 1, 3}, {3, 2, 1}}));
  EXPECT_EQ(soup.names, (std::vector<std::size_t>{0, 1, 1}));
  EXPECT_EQ(soup.known_names, (std::vector<Names>{{"organ", "top"}, {"organ", "top", "glue"}}));
}

TEST_F(ReadObj, AnIndexOfNoVertexIsOutOfRange) {
  // Vertices count from 1, and from -1 backwards: 0 is none, nor is the third before the first two.
  const Soup soup = read("v 0 0 0\nv 1 0 0\nf 0 1 2\nf -3 1 2\nf -2 -1 1\n");
  EXPECT_GE(soup.polygons.at(0).at(0), soup.points.size());
  EXPECT_GE(soup.polygons.at(1).at(0), soup.points.size());
  EXPECT_EQ(soup.polygons.at(2), (std::vector<std::size_t>{0, 1, 0}));
}

TEST_F(ReadObj, NamesTheLineOfWhatIsNoNumber) {
  expect_refusal([&] { read("v 0 0 0\nv 1 zero 0\n"); }, "a.obj",
                 "line 2: a vertex without three numbers", "export");
  expect_refusal([&] { read("v 0 0 0\nf 1 x 1\n"); }, "a.obj",
                 "line 2: a face with an index that is no number", "export");
}

}  // namespace
}  // namespace palpate::mesher
