// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/vtk/vtk_data.hpp"

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

/// Two tetrahedra on a common face, and a triangle.
VtkData two_tetrahedra() {
  VtkData data;
  data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  data.types = {VtkTetrahedron, VtkTetrahedron, VtkTriangle};
  data.offsets = {4, 8, 11};
  data.connectivity = {0, 1, 2, 3, 1, 2, 3, 4, 0, 1, 2};
  return data;
}

TEST(VtkData, RegionsAreTheOnlyIntegerArrayOrTheOneOfAUsualName) {
  VtkData data = two_tetrahedra();
  EXPECT_EQ(volume_entities(data, "", "a").region_names, std::vector<std::string>{"matrix"});
  data.cell_arrays = {{"density", 1, false, {1, 2, 3}}, {"part", 1, true, {4, 5, 6}}};
  EXPECT_EQ(volume_entities(data, "", "a").region_names,
            (std::vector<std::string>{"part=4", "part=5"}));
  data.cell_arrays.push_back({"colour", 1, true, {1, 1, 1}});
  expect_refusal([&] { volume_entities(data, "", "a.vtu"); }, "a.vtu", "part, colour",
                 "region_array");
  EXPECT_EQ(volume_entities(data, "colour", "a").region_names,
            (std::vector<std::string>{"colour=1"}));
  data.cell_arrays.push_back({"MaterialId", 1, true, {8, 9, 9}});
  EXPECT_EQ(volume_entities(data, "", "a").region_names,
            (std::vector<std::string>{"MaterialId=8", "MaterialId=9"}));
  expect_refusal([&] { volume_entities(data, "density", "a.vtu"); }, "a.vtu",
                 "no integer cell array 'density'", "part");
}

TEST(VtkData, AnArrayOfStringsNamesTheRegions) {
  VtkData data = two_tetrahedra();
  data.cell_arrays = {{"region", 1, true, {1, 0, 1}}};
  data.texts["region_names"] = {"muscle", "fat"};
  EXPECT_EQ(volume_entities(data, "", "a").region_names,
            (std::vector<std::string>{"fat", "muscle"}));
}

TEST(VtkData, IntegerArraysOfFewValuesAreSets) {
  VtkData data = two_tetrahedra();
  data.point_arrays = {{"fixed", 1, true, {1, 0, 0, 0, 1}},
                       {"zone", 1, true, {2, 2, 3, 3, 3}},
                       {"height", 1, false, {0, 1, 0, 1, 0}},
                       {"normal", 3, true, std::vector<double>(15, 1)}};
  data.cell_arrays = {{"region", 1, true, {7, 7, 9}}};
  const MeshEntities mesh = volume_entities(data, "", "a");
  EXPECT_EQ(
      mesh.node_sets,
      (std::map<std::string, std::vector<std::int32_t>>{
          {"fixed", {0, 4}}, {"zone=2", {0, 1}}, {"zone=3", {2, 3, 4}}, {"region=9", {0, 1, 2}}}));
}

TEST(VtkData, RefusesCellsThatContradictThemselves) {
  const auto refused = [](const auto& damage, const std::string& problem) {
    VtkData data = two_tetrahedra();
    damage(data);
    expect_refusal([&] { check_cells(data, "a.vtk"); }, "a.vtk", problem);
  };
  refused([](VtkData& d) { d.connectivity[6] = 5; }, "cell 1 has point 5 of 5 points");
  refused([](VtkData& d) { d.connectivity[6] = -1; }, "cell 1 has point -1");
  refused([](VtkData& d) { d.offsets[1] = 3; }, "cell 1 ends at 3");
  refused([](VtkData& d) { d.offsets[2] = 12; }, "cell 2 ends at 12 of 11");
  refused([](VtkData& d) { d.offsets[0] = 5; }, "cell 0 has 5 points, 4 expected");
  refused([](VtkData& d) { d.types[2] = 99; }, "type 99");
}

TEST(VtkData, PolygonsAreNamedByTheirArrays) {
  VtkData data;
  data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
  data.types = {VtkPolyLine, VtkPolygon, VtkStrip};
  data.offsets = {2, 5, 10};
  data.connectivity = {0, 1, 0, 1, 2, 0, 1, 2, 3, 4};
  data.cell_arrays = {{"side", 1, true, {0, 4, 5}}, {"held", 1, true, {0, 0, 1}}};
  const Soup soup = surface_of(data, "a");
  EXPECT_EQ(soup.polygons,
            (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
  ASSERT_EQ(soup.names.size(), 4U);
  EXPECT_EQ(soup.known_names[soup.names[0]], (Names{"side=4", "held=0"}));
  EXPECT_EQ(soup.known_names[soup.names[3]], (Names{"side=5", "held=1", "held"}));
}

}  // namespace
}  // namespace palpate::mesher
