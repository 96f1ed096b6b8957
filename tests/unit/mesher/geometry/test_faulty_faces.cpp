// SPDX-License-Identifier: AGPL-3.0-or-later
// What the file of faulty faces says to a reader of VTK files.
#include "mesher/geometry/faulty_faces.hpp"

#include <gtest/gtest.h>

#include "mesher/read/vtk/read_vtk_xml.hpp"
#include "mesher/read/vtk/vtk_data.hpp"

namespace palpate::mesher {
namespace {

FaultyFaces faces() {
  FaultyFaces faces;
  faces.add({0, 0, 0}, {1, 0, 0}, {0, 1, 1.0 / 3}, Fault::SelfIntersection);
  faces.add({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {0, 1, 2, 3}, Fault::BorderEdge);
  return faces;
}

TEST(FaultyFaces, APolygonIsAFan) {
  const FaultyFaces f = faces();
  ASSERT_EQ(f.faults.size(), 3U);
  ASSERT_EQ(f.points.size(), 9U);
  EXPECT_EQ(f.points[6], (Vec3{0, 0, 0}));
  EXPECT_EQ(f.points[7], (Vec3{2, 2, 0}));
  EXPECT_EQ(f.points[8], (Vec3{0, 2, 0}));
}

TEST(FaultyFaces, AreReadBackFromTheirFileWithTheFaultOfEach) {
  const Soup soup = surface_of(read_vtk_xml(vtp_text(faces()), "faulty-faces.vtp"), "faulty");
  ASSERT_EQ(soup.polygons.size(), 3U);
  EXPECT_EQ(soup.points.at(soup.polygons[0][2]), (Vec3{0, 1, 1.0 / 3}));
  ASSERT_EQ(soup.names.size(), 3U);
  // The reader names faces by the values of their cell arrays.
  EXPECT_NE(soup.names[0], soup.names[1]);
  EXPECT_EQ(soup.names[1], soup.names[2]);
}

TEST(FaultySurface, IsAnErrorOfTheGeometryThatCarriesTheFaces) {
  try {
    throw FaultySurface("body.stl", "it has a hole", "close it", faces());
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_STREQ(error.what(), "body.stl: it has a hole; close it");
    const auto* faulty = dynamic_cast<const FaultySurface*>(&error);
    ASSERT_NE(faulty, nullptr);
    EXPECT_EQ(faulty->faces().faults.size(), 3U);
  }
}

}  // namespace
}  // namespace palpate::mesher
