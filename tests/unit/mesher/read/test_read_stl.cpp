// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/read_stl.hpp"

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\n"
    "endfacet\n";

TEST(ReadStl, FacesHaveTheNamesOfTheirSolids) {
  const Soup soup =
      read_text_stl("solid left side\n" + kFacet + "endsolid left side\nsolid\n" + kFacet +
                        "endsolid\nSOLID left side\n" + kFacet + "endsolid\n",
                    "a.stl");
  EXPECT_EQ(soup.polygons.size(), 3U);
  EXPECT_EQ(soup.points.size(), 9U);
  EXPECT_EQ(soup.known_names, (std::vector<Names>{{"left side"}, {}}));
  EXPECT_EQ(soup.names, (std::vector<std::size_t>{0, 1, 0}));
}

TEST(ReadStl, TellsTextFromBinary) {
  EXPECT_TRUE(is_text_stl("solid a\n" + kFacet));
  EXPECT_FALSE(is_text_stl("solid a" + std::string(100, '\0')));
  EXPECT_FALSE(is_text_stl("binary header"));
}

TEST(ReadStl, NamesTheLineOfAFault) {
  const auto refused = [](const std::string& bytes, const std::string& where,
                          const std::string& problem) {
    expect_refusal([&] { read_text_stl(bytes, "a.stl"); }, where, problem);
  };
  refused("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", "a.stl:4", "the line ends");
  refused("solid a\nvertex 0 0 inf\n", "a.stl:2", "not finite");
  refused("solid a\nouter loop\nvertex 0 0 0\nendloop\n", "a.stl:4", "fewer than three");
  refused("solid a\nouter loop\nvertex 0 0 0\n", "a.stl:3", "ends inside a face");
  refused("solid a\nonce upon a time\n", "a.stl:2", "none of an STL file");
}

}  // namespace
}  // namespace palpate::mesher
