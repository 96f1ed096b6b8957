// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/read_ply.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

const std::string kTetrahedron =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kPoints = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string kFaces = "element face 2\nproperty list uchar int vertex_indices\n";

std::string text_file(const std::string& header, const std::string& data) {
  return "ply\nformat ascii 1.0\ncomment of a test\n" + header + "end_header\n" + data;
}

template <typename Number>
void put(std::string& bytes, Number value, bool reversed) {
  char copy[sizeof value];
  std::memcpy(copy, &value, sizeof value);
  if (reversed) std::reverse(copy, copy + sizeof value);
  bytes.append(copy, sizeof value);
}

TEST(ReadPly, TextHasItsPointsAndPolygons) {
  const Soup soup =
      read_ply(text_file(kTetrahedron + kFaces, kPoints + "3 0 1 2\n4 0 1 2 3\n"), "a.ply");
  EXPECT_EQ(soup.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(soup.polygons, (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {0, 1, 2, 3}}));
  EXPECT_TRUE(soup.names.empty());
}

TEST(ReadPly, BinaryOfEitherByteOrderIsTheSame) {
  for (const bool big : {false, true}) {
    const bool reversed = big != (std::endian::native == std::endian::big);
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\nelement vertex 3\nproperty double x\nproperty short flag\n"
                        "property double y\nproperty float z\nelement face 1\n"
                        "property list ushort uint vertex_index\nend_header\n";
    for (int v = 0; v < 3; ++v) {
      put(bytes, 0.1 * v, reversed);
      put(bytes, std::int16_t{-7}, reversed);
      put(bytes, 1.0 / (1 + v), reversed);
      put(bytes, 2.5F, reversed);
    }
    put(bytes, std::uint16_t{3}, reversed);
    for (const std::uint32_t v : {2U, 0U, 1U}) put(bytes, v, reversed);
    const Soup soup = read_ply(bytes, "a.ply");
    EXPECT_EQ(soup.points, (std::vector<Vec3>{{0, 1, 2.5}, {0.1, 0.5, 2.5}, {0.2, 1.0 / 3, 2.5}}));
    EXPECT_EQ(soup.polygons, (std::vector<std::vector<std::size_t>>{{2, 0, 1}}));
  }
}

TEST(ReadPly, TheColourOfAFaceIsItsName) {
  const std::string colours = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const Soup soup = read_ply(
      text_file(kTetrahedron + kFaces + colours, kPoints + "3 0 1 2 255 0 0\n3 0 1 3 16 32 64\n"),
      "a.ply");
  EXPECT_EQ(soup.known_names, (std::vector<Names>{{"#ff0000"}, {"#102040"}}));
  EXPECT_EQ(soup.names, (std::vector<std::size_t>{0, 1}));
}

TEST(ReadPly, TheColourOfMostCornersIsTheNameOfAFaceWithoutItsOwn) {
  const std::string colours = "property float red\nproperty float green\nproperty float blue\n";
  const Soup soup = read_ply(
      text_file(kTetrahedron + colours + "element face 3\nproperty list uchar int vertex_indices\n",
                "0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 0 1 0\n0 0 1 0 0 nan\n"
                "3 0 1 2\n3 0 2 3\n3 0 1 3\n"),
      "a.ply");
  ASSERT_EQ(soup.names.size(), 3U);
  EXPECT_EQ(soup.known_names[soup.names[0]], Names{"#ff0000"});
  EXPECT_EQ(soup.known_names[soup.names[1]], Names{});  // three colours
  EXPECT_EQ(soup.known_names[soup.names[2]], Names{"#ff0000"});
}

TEST(ReadPly, TheTrianglesOfStripsTurnAlternately) {
  // 0 1 2 3, then a new strip of one triangle; its repeated index makes none.
  const Soup soup = read_ply(
      text_file(kTetrahedron + "element tristrips 1\nproperty list int int vertex_indices\n",
                kPoints + "9 0 1 2 3 -1 3 1 0 0\n"),
      "a.ply");
  EXPECT_EQ(soup.polygons,
            (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {2, 1, 3}, {3, 1, 0}}));
}

TEST(ReadPly, RefusesWhatItCannotRead) {
  const auto read = [](const std::string& bytes) { return [=] { read_ply(bytes, "a.ply"); }; };
  expect_refusal(read("once upon a time"), "a.ply:1", "does not begin with 'ply'");
  expect_refusal(read("ply\nformat morse 1.0\nend_header\n"), "a.ply:2", "unknown format 'morse'");
  expect_refusal(read("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n"),
                 "a.ply:4", "unknown type 'half'");
  expect_refusal(read(text_file(kTetrahedron + kFaces, kPoints + "3 0 1 2\n3 0 1 4\n")), "a.ply:16",
                 "the index 4");
  expect_refusal(read(text_file(kTetrahedron + kFaces, kPoints + "3 0 1 2\n")), "a.ply",
                 "the file ends");
  expect_refusal(read(text_file(kTetrahedron, "0 0 0\n1 zero 0\n0 0 0\n0 0 0\n")), "a.ply:10",
                 "'zero'");
  expect_refusal(read(text_file(kTetrahedron, "0 0 0\n1 nan 0\n0 0 0\n0 0 0\n")), "a.ply:10",
                 "not finite");
  expect_refusal(read(text_file("element vertex 4000000000\nproperty float x\n", "0\n")), "a.ply:4",
                 "4000000000");
  expect_refusal(read(text_file(kTetrahedron + "element face 1\nproperty list uchar int colours\n",
                                kPoints + "3 0 1 2\n")),
                 "a.ply", "a face without vertex_indices");
  // The header leaves room for so many faces, what the points leave does not.
  expect_refusal(
      read(text_file(kTetrahedron + "element face 40\nproperty list uchar int vertex_indices\n",
                     kPoints + "3 0 1 2\n")),
      "a.ply", "face is 40, more than the");
  expect_refusal(read(text_file("element vertex 1\nproperty float x\nproperty float y\n", "0 0\n")),
                 "a.ply", "without x, y and z");
}

}  // namespace
}  // namespace palpate::mesher
