// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "mesher/read/read_obj.hpp"
#include "tests/unit/mesher/refusals.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using test::expect_file_refused;
using test::TemporaryFile;

TEST(ReadObj, KeepsTheNamesOfObjectGroupsAndMaterial) {
  const TemporaryFile file("names.obj",
                           "o organ\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng top # lid\nf 1 2 3\n"
                           "usemtl glue\nf 1 2 \\\n4\ng top\nf -1 -2 -3\n");
  const Soup soup = read_obj(file.path());
  EXPECT_EQ(soup.points.size(), 4U);
  EXPECT_EQ(soup.polygons,
            (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {0, 1, 3}, {3, 2, 1}}));
  EXPECT_EQ(soup.names, (std::vector<std::size_t>{0, 1, 1}));
  EXPECT_EQ(soup.known_names, (std::vector<Names>{{"organ", "top"}, {"organ", "top", "glue"}}));
}

TEST(ReadObj, NamesTheLineOfAVertexWithoutThreeNumbers) {
  expect_file_refused("word.obj", "v 0 0 0\nv 1 zero 0\n", "line 2: a vertex without three numbers",
                      "export");
}

}  // namespace
}  // namespace palpate::mesher
