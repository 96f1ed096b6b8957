// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Surface cube() {
  return test::box({0, 0, 0}, {0.05, 0.05, 0.05});
}

Diagnosis of(const Surface& surface) {
  return diagnose(test::soup_of(surface), "body.stl");
}

long count(const Diagnosis& diagnosis, Fault fault) {
  return std::count(diagnosis.faces.faults.begin(), diagnosis.faces.faults.end(), fault);
}

TEST(Diagnosis, OfASoundSurfaceIsEmpty) {
  EXPECT_THAT(of(cube()).findings, IsEmpty());
  EXPECT_THAT(of(cube()).faces.faults, IsEmpty());
}

TEST(Diagnosis, NamesAHoleWithItsPlaceAndSize) {
  const auto at_the_top = [](const Vec3& x) { return x[2] == 0.05; };
  const Diagnosis open = of(test::without(cube(), at_the_top));
  EXPECT_THAT(open.findings, Contains(HasSubstr("4 border edges")));
  EXPECT_THAT(open.findings,
              Contains(HasSubstr("1 hole, the largest first: 70.7107 mm at (25, 25, 50) mm")));
  EXPECT_EQ(count(open, Fault::BorderEdge), 4);
}

TEST(Diagnosis, CountsFacesThatOccurTwiceAndTheEdgesThatTheyCrowd) {
  Surface surface = cube();
  surface.triangles.push_back(surface.triangles.front());
  const Diagnosis doubled = of(surface);
  EXPECT_THAT(doubled.findings, Contains("1 duplicate or collapsed face"));
  EXPECT_THAT(doubled.findings, Contains(HasSubstr("3 edges with more than two faces")));
}

TEST(Diagnosis, CountsTheEdgesOfAFaceThatIsReversed) {
  Surface surface = cube();
  std::swap(surface.triangles[0][1], surface.triangles[0][2]);
  EXPECT_THAT(of(surface).findings,
              ElementsAre(HasSubstr("3 edges between faces of opposite orientation")));
}

TEST(Diagnosis, TellsASurfaceThatIsInsideOut) {
  Surface surface = cube();
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  EXPECT_THAT(of(surface).findings, ElementsAre("all faces point inward"));
}

TEST(Diagnosis, ListsPartsBySize) {
  const Surface small = test::box({0.1, 0, 0}, {0.12, 0.02, 0.02});
  const Diagnosis parts = of(test::joined(small, cube()));
  ASSERT_EQ(parts.findings.size(), 1U);
  EXPECT_THAT(parts.findings[0], HasSubstr("2 separate parts, the largest first: (0, 0, 0) mm to "
                                           "(50, 50, 50) mm, 15000 mm^2, 125000 mm^3"));
}

TEST(Diagnosis, CountsPairsThatCross) {
  const Surface second = test::box({0.02, 0.02, 0.02}, {0.08, 0.08, 0.08});
  const Diagnosis crossing = of(test::joined(cube(), second));
  EXPECT_THAT(crossing.findings, Contains(HasSubstr("of faces that cross")));
  EXPECT_GT(count(crossing, Fault::SelfIntersection), 0);
}

TEST(Diagnosis, CountsFacesOfNoArea) {
  const Diagnosis flat = of(test::with_a_face_of_no_area(cube()));
  EXPECT_THAT(flat.findings, Contains(HasSubstr("1 face of zero area")));
  EXPECT_EQ(count(flat, Fault::ZeroArea), 1);
}

}  // namespace
}  // namespace palpate::mesher
