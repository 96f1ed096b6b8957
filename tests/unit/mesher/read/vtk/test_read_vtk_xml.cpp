// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/vtk/read_vtk_xml.hpp"

#include "mesher/geometry/surface.hpp"
#include "mesher/read/file/file.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

TEST(ReadVtkXml, EveryEncodingGivesTheMeshThatVtkStates) {
  for (const char* name :
       {"vtk/body_ascii.vtu", "vtk/body_binary.vtu", "vtk/body_binary_zlib.vtu",
        "vtk/body_appended.vtu", "vtk/body_appended_zlib.vtu", "vtk/body_raw.vtu"}) {
    SCOPED_TRACE(name);
    const VolumeMesh mesh = test::read_file(name);
    test::expect_body(mesh, "region=1", "region=2", "region=3");
    EXPECT_EQ(mesh.node_sets.at("top").size(), 43U);
    EXPECT_EQ(test::heights(mesh, "top"), std::pair(20.0, 20.0));
    EXPECT_EQ(test::heights(mesh, "region=9"), std::pair(0.0, 0.0));
    EXPECT_FALSE(mesh.node_sets.contains("height"));
  }
}

TEST(ReadVtkXml, ReadsWhatMeshioWrites) {
  test::expect_body(test::read_file("meshio/body.vtu"), "material=11", "material=12",
                    "material=13");
}

TEST(ReadVtkXml, SurfacesHaveTheSidesThatVtkGaveThem) {
  for (const char* name : {"box_ascii.vtp", "box_binary.vtp", "box_binary_zlib.vtp",
                           "box_appended.vtp", "box_appended_zlib.vtp"}) {
    SCOPED_TRACE(name);
    const auto path = test::mesh_file(std::string("vtk/") + name);
    const Soup soup = surface_of(read_vtk_xml(read_bytes(path), name), name);
    ASSERT_EQ(soup.polygons.size(), 6U);
    EXPECT_EQ(soup.points.size(), 24U);
    EXPECT_EQ(soup.known_names[soup.names[5]], Names{"side=5"});
    for (const auto& corners : soup.polygons) EXPECT_EQ(corners.size(), 4U);
  }
}

TEST(ReadVtkXml, StripsAreTrianglesThatFaceOneWay) {
  const auto path = test::mesh_file("vtk/box_strips.vtp");
  const Soup soup = surface_of(read_vtk_xml(read_bytes(path), "a"), "a");
  Surface surface{soup.points, {}, {}, {}};
  for (const auto& corners : soup.polygons)
    surface.triangles.push_back({static_cast<std::int32_t>(corners.at(0)),
                                 static_cast<std::int32_t>(corners.at(1)),
                                 static_cast<std::int32_t>(corners.at(2))});
  EXPECT_EQ(surface.triangles.size(), 12U);
  EXPECT_NEAR(signed_volume(surface), 40 * 30 * 20, 1e-6);
}

std::string grid(const std::string& points, const std::string& rest = "") {
  return "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
         "<Piece NumberOfPoints=\"1\" NumberOfCells=\"0\">\n<Points>\n"
         "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" " +
         points + "</DataArray></Points></Piece></UnstructuredGrid>" + rest + "</VTKFile>";
}

TEST(ReadVtkXml, NamesTheLineAndTheArrayOfAFault) {
  const auto refused = [](const std::string& bytes, const std::string& where,
                          const std::string& problem) {
    expect_refusal([&] { read_vtk_xml(bytes, "a.vtu"); }, where, problem);
  };
  refused("once upon", "a.vtu:1", "XML is damaged");
  refused("<a/>", "a.vtu", "no VTKFile");
  refused("<VTKFile type=\"ImageData\"/>", "a.vtu:1", "type 'ImageData'");
  refused("<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"/>", "a.vtu:1",
          "vtkLZ4DataCompressor");
  EXPECT_EQ(read_vtk_xml(grid("format=\"ascii\">1 2 3"), "a.vtu").points.size(), 1U);
  refused(grid("format=\"ascii\">1 2"), "a.vtu:5: Points", "2 numbers, 3 expected");
  refused(grid("format=\"ascii\">1 2 x"), "a.vtu:5: Points", "no number");
  refused(grid("format=\"binary\">AAA"), "a.vtu:5: Points", "at most 0 follow");
  refused(grid("format=\"binary\">GAAAAAAA"), "a.vtu:5: Points", "24 bytes");
  refused(grid("format=\"binary\">GAA*AAAA"), "a.vtu:5: Points", "base64");
  refused(grid("format=\"other\">1"), "a.vtu:5: Points", "format 'other'");
  refused(grid("format=\"appended\" offset=\"99\">", "<AppendedData encoding=\"raw\">\n_123"),
          "a.vtu:5: Points", "begins at byte 99");
}

TEST(ReadVtkXml, CountsBeyondTheFileAreRefusedBeforeAnythingIsAllocated) {
  const std::string bytes =
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>"
      "<Piece NumberOfPoints=\"1000000000000000000\" NumberOfCells=\"0\"><Points>"
      "<DataArray type=\"Float64\" Name=\"Points\" format=\"ascii\">1 2 3</DataArray></Points>"
      "</Piece></UnstructuredGrid></VTKFile>";
  expect_refusal([&] { read_vtk_xml(bytes, "a.vtu"); }, "a.vtu:1",
                 "NumberOfPoints is '1000000000000000000'");
}

}  // namespace
}  // namespace palpate::mesher
