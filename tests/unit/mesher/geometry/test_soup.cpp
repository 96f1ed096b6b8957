// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <type_traits>

#include "format/error.hpp"
#include "mesher/geometry/soup.hpp"
#include "mesher/read/read_surface.hpp"
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

/// A box whose lid has its own corners, `gap` above those of the walls.
std::string box_with_a_loose_lid(double gap) {
  Surface s = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  std::map<std::size_t, std::size_t> own;
  for (Triangle& t : s.triangles) {
    const auto of_lid = [&](auto v) { return s.points[static_cast<std::size_t>(v)][2] > 0.04; };
    if (!std::all_of(t.begin(), t.end(), of_lid)) continue;
    for (auto& v : t) {
      const auto corner = static_cast<std::size_t>(v);
      if (!own.contains(corner)) {
        own[corner] = s.points.size();
        s.points.push_back(s.points[corner] + Vec3{0, 0, gap});
      }
      v = static_cast<std::remove_reference_t<decltype(v)>>(own[corner]);
    }
  }
  return off_text(s);
}

TEST(Soup, TidyClosesSeamsThatDifferByRoundingAndNoOthers) {
  std::string log;
  const Log collect = [&](std::string_view line) { log += std::string(line) + "\n"; };
  const TemporaryFile rounded("rounded.off", box_with_a_loose_lid(5e-8));
  const Surface closed = read_surface({rounded.path(), 1, ""}, collect);
  EXPECT_EQ(closed.points.size(), 8U);
  EXPECT_NEAR(signed_volume(closed), 0.05 * 0.05 * 0.05, 1e-9);
  EXPECT_THAT(log, testing::HasSubstr("closed a seam: merged 4 points"));
  const TemporaryFile open("open.off", box_with_a_loose_lid(5e-7));
  EXPECT_THROW(read_surface({open.path(), 1, "", {RepairMode::None}}, collect), Error);
}

TEST(Soup, RefusesNumbersThatAreNotFiniteAndBadIndices) {
  expect_file_refused("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n",
                      "1 point with a coordinate that is not finite (NaN or Inf), number 3 of",
                      "coordinates");
  expect_file_refused("nans.obj", "v 0 0 0\nv 1 inf 0\nv 0 nan 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n",
                      "2 points with a coordinate that is not finite (NaN or Inf), the first of "
                      "them number 2 of",
                      "coordinates");
  expect_file_refused("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 0\nf -1 -2 -4\n",
                      "3 faces with an index outside the 3 vertices", "damaged");
  expect_file_refused("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1 2 3\n",
                      "1 face with fewer than three indices", "export");
}

TEST(Soup, RefusesBadTopologyWithItsCounts) {
  Surface open = cube();
  open.triangles.pop_back();
  expect_file_refused("open.off", off_text(open), "not watertight: 3 border edges",
                      "close its holes");

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
  expect_file_refused("pinched.off", off_text(pinched), "meet only in 1 point", "separate");
}

TEST(Soup, RefusesAOneSidedSurface) {
  // A Klein bottle: the grid of a torus whose second direction is joined in reverse.
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

}  // namespace
}  // namespace palpate::mesher
