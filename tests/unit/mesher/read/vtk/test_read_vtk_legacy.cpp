// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/vtk/read_vtk_legacy.hpp"

#include "mesher/read/file/file.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

TEST(ReadVtkLegacy, EveryVersionAndEncodingGivesTheMeshThatVtkStates) {
  for (const char* name :
       {"vtk/body_4.vtk", "vtk/body_4_binary.vtk", "vtk/body_5.vtk", "vtk/body_5_binary.vtk"}) {
    SCOPED_TRACE(name);
    const VolumeMesh mesh = test::read_file(name);
    test::expect_body(mesh, "region=1", "region=2", "region=3");
    EXPECT_EQ(mesh.node_sets.at("top").size(), 43U);
    EXPECT_EQ(test::heights(mesh, "region=9"), std::pair(0.0, 0.0));
  }
}

TEST(ReadVtkLegacy, ReadsWhatMeshioAndGmshWrite) {
  test::expect_body(test::read_file("meshio/body.vtk"), "material=11", "material=12",
                    "material=13");
  // Gmsh numbers its entities, not its physical groups, in this format.
  const VolumeMesh entities = test::read_file("gmsh/body.vtk");
  EXPECT_EQ(entities.tetrahedra.size(), 565U);
  EXPECT_EQ(entities.region_names.size(), 3U);
}

TEST(ReadVtkLegacy, SurfacesHaveTheSidesThatVtkGaveThem) {
  for (const char* name : {"box_4.vtk", "box_5_binary.vtk"}) {
    SCOPED_TRACE(name);
    const auto path = test::mesh_file(std::string("vtk/") + name);
    const Soup soup = surface_of(read_vtk_legacy(read_bytes(path), name), name);
    ASSERT_EQ(soup.polygons.size(), 6U);
    EXPECT_EQ(soup.known_names[soup.names[5]], Names{"side=5"});
  }
}

const std::string kHead = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string kGrid = kHead +
                          "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\n"
                          "CELL_TYPES 1\n10\n";

TEST(ReadVtkLegacy, SkipsWhatIsNoGroup) {
  const VtkData data = read_vtk_legacy(
      kGrid +
          "POINT_DATA 4\nSCALARS heat%20flux double 1\nLOOKUP_TABLE default\n1 2 3 4\n"
          "LOOKUP_TABLE other 2\n0 0 0 1 1 1 1 1\nVECTORS v float\n0 0 0 0 0 0 0 0 0 0 0 0\n"
          "CELL_DATA 1\nCOLOR_SCALARS c 3\n.1 .2 .3\nFIELD FieldData 2\n"
          "part 1 1 int\n6\nname 1 1 string\nsome%20words\n",
      "a.vtk");
  ASSERT_EQ(data.point_arrays.size(), 2U);
  EXPECT_EQ(data.point_arrays[0].name, "heat flux");
  ASSERT_EQ(data.cell_arrays.size(), 1U);
  EXPECT_EQ(data.cell_arrays[0].values, std::vector<double>{6});
}

TEST(ReadVtkLegacy, NamesTheLineOfAFault) {
  const auto refused = [](const std::string& bytes, const std::string& where,
                          const std::string& problem) {
    expect_refusal([&] { read_vtk_legacy(bytes, "a.vtk"); }, where, problem);
  };
  refused("solid\n", "a.vtk:1", "does not begin");
  refused("# vtk DataFile Version 3.0\nt\nHEX\n", "a.vtk:3", "neither ASCII nor BINARY");
  refused("# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n", "a.vtk:4",
          "structured_points");
  refused(kHead + "POINTS 1000000000000000000 float\n", "a.vtk:5", "more than the");
  refused(kHead + "POINTS 2 float\n0 0 0\n0 one 0\n", "a.vtk:7", "no number");
  refused(kHead + "POINTS 1 quaternion\n0 0 0\n", "a.vtk:5", "type 'quaternion'");
  refused(kGrid + "CELL_DATA 2\n", "a.vtk:11", "2 rows, 1 expected");
  refused(kGrid + "CELLS 1 5\n5 0 1 2 3\n", "a.vtk:12", "does not fit");
  refused(kGrid + "FLYING 1\n", "a.vtk:11", "'flying'");
}

}  // namespace
}  // namespace palpate::mesher
