// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/attempts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "format/error.hpp"
#include "mesher/volume/boundary.hpp"
#include "mesher/volume/label_oracle.hpp"
#include "tests/unit/mesher/lattice.hpp"

namespace palpate::mesher {
namespace {

/// The unit cubes with these lowest corners, as labels.
LabelField field_of(const test::Cells& cells) {
  LabelField field;
  field.box = {{0, 0, 0}, {4, 4, 4}};
  field.resolution = 0.1;
  field.region_names = {"matrix"};
  field.region = [cells](const Vec3& x) {
    const auto lowest = [](double c) { return static_cast<int>(std::floor(c)); };
    const test::Cell cell{lowest(x[0]), lowest(x[1]), lowest(x[2])};
    return std::find(cells.begin(), cells.end(), cell) == cells.end() ? kVoid : 0;
  };
  return field;
}

struct Meshed {
  VolumeMesh mesh;
  DelaunayReport report;
  std::string log;
};

Meshed refined(const LabelField& field, double size, double most_volume_change = 0.03) {
  const auto oracle = make_oracle(field);
  std::vector<SizeSource> sizes;
  for (const Crossing& seed : oracle->seeds([=](const Vec3&) { return size / 2; }))
    sizes.push_back({seed.point, size});
  Meshed result;
  result.mesh = refine_until_sound(
      {*oracle, sizes, [=](const Vec3&) { return 1.5 * size; }, size, most_volume_change, 175,
       1'000'000, [](const Vec3& x) { return text("(", x[0], ", ", x[1], ", ", x[2], ")"); },
       "labels", [&](std::string_view line) { result.log += text(line, "\n"); }},
      result.report);
  return result;
}

TEST(Attempts, OneSufficesForACube) {
  const Meshed cube = refined(field_of({{1, 1, 1}}), 0.4);
  EXPECT_EQ(cube.report.attempts, 1);
  EXPECT_EQ(cube.log, "");
  EXPECT_NEAR(cube.report.volume_of_domain, 1, 0.01);
  EXPECT_NEAR(cube.report.quality.volume, 1, 0.03);
}

TEST(Attempts, ARingThatMeetsItselfInAnEdgeIsTakenApart) {
  const Meshed ring = refined(field_of(test::kRingAroundAnEdge), 0.5);
  EXPECT_GT(ring.report.attempts, 1);
  EXPECT_THAT(ring.log, testing::HasSubstr("where the boundary touches itself"));
  EXPECT_TRUE(pinches(adjacency(ring.mesh.tetrahedra).boundary).nodes.empty());
  EXPECT_EQ(adjacency(ring.mesh.tetrahedra).parts, 1);
  EXPECT_EQ(ring.mesh.region.size(), ring.mesh.tetrahedra.size());
  EXPECT_NEAR(ring.report.quality.volume, 8, 0.24);
}

TEST(Attempts, RefusesAVolumeThatCannotBeReachedWithinFourAndSaysWhere) {
  try {
    refined(field_of({{1, 1, 1}}), 0.4, 1e-12);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_EQ(error.where(), "labels");
    EXPECT_THAT(error.problem(), testing::HasSubstr("the volume of the mesh differs"));
    EXPECT_THAT(error.problem(), testing::HasSubstr("farthest from it at ("));
  }
}

}  // namespace
}  // namespace palpate::mesher
