// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/export/mesh_file.hpp"

#include <functional>

#include "mesher/read/mesh/assemble.hpp"
#include "mesher/read/mesh/read_abaqus.hpp"
#include "mesher/read/mesh/read_febio.hpp"
#include "mesher/read/mesh/read_gmsh.hpp"
#include "mesher/read/read_off.hpp"
#include "mesher/read/vtk/read_vtk_xml.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::app {
namespace {

using mesher::MeshEntities;
using mesher::VolumeMesh;

/// A body of a mesh file with sets of every kind.
Body body_of(const std::string& file) {
  const VolumeMesh mesh = mesher::test::read_file(file);
  Body body;
  body.nodes = mesh.nodes;
  body.tetrahedra = mesh.tetrahedra;
  body.tetrahedron_region = mesh.region;
  body.region_names = mesh.region_names;
  body.curved_edges = mesh.curved_edges;
  body.boundary = mesher::adjacency(mesh.tetrahedra).boundary;
  body.fixed_nodes = {1, 4, 7};
  body.foundation = {{2, 1e6, 0}};
  for (const std::int32_t node : body.boundary[0]) body.response.node.push_back(node);
  body.response.is_site = {0, 1, 1};
  return body;
}

struct Format {
  const char* name;
  std::function<std::string(const Body&)> write;
  std::function<MeshEntities(const std::string&)> read;
};
const std::vector<Format> kFormats{
    {"gmsh", gmsh_mesh, [](const std::string& bytes) { return mesher::read_gmsh(bytes, "a"); }},
    {"vtu", vtu_mesh,
     [](const std::string& bytes) {
       return mesher::volume_entities(mesher::read_vtk_xml(bytes, "a"), "", "a");
     }},
    {"inp", abaqus_mesh, [](const std::string& bytes) { return mesher::read_abaqus(bytes, "a"); }},
    {"feb", febio_mesh, [](const std::string& bytes) { return mesher::read_febio(bytes, "a"); }}};

std::vector<std::int32_t> sorted(std::vector<std::int32_t> nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Tetrahedra by region, whatever their order in the file.
std::set<std::pair<std::string, Tetrahedron>> tetrahedra_of(
    const std::vector<Tetrahedron>& tetrahedra, const std::vector<std::int32_t>& region,
    const std::vector<std::string>& names) {
  std::set<std::pair<std::string, Tetrahedron>> found;
  for (std::size_t t = 0; t < tetrahedra.size(); ++t)
    found.emplace(names[static_cast<std::size_t>(region[t])], tetrahedra[t]);
  return found;
}

void expect_round_trip(const Body& body, const Format& format) {
  SCOPED_TRACE(format.name);
  const VolumeMesh read = mesher::assemble(format.read(format.write(body)), 1, format.name, {});
  ASSERT_EQ(read.nodes.size(), body.nodes.size());
  ASSERT_EQ(read.curved_edges.size(), body.curved_edges.size());
  const double largest = format.name == std::string("inp") ? 1e-14 : 0;  // m
  for (std::size_t i = 0; i < body.nodes.size(); ++i)
    EXPECT_LE(norm(read.nodes[i] - body.nodes[i]), largest);
  for (std::size_t i = 0; i < body.curved_edges.size(); ++i) {
    EXPECT_EQ(read.curved_edges[i].ends, body.curved_edges[i].ends);
    EXPECT_LE(norm(read.curved_edges[i].middle - body.curved_edges[i].middle), largest);
  }
  EXPECT_EQ(tetrahedra_of(read.tetrahedra, read.region, read.region_names),
            tetrahedra_of(body.tetrahedra, body.tetrahedron_region, body.region_names));
  EXPECT_EQ(read.node_sets.at("fixed"), body.fixed_nodes);
  const Triangle& sprung = body.boundary[2];
  EXPECT_EQ(read.node_sets.at("sprung"), sorted({sprung.begin(), sprung.end()}));
  EXPECT_EQ(read.node_sets.at("response"), sorted(body.response.node));
  EXPECT_EQ(read.node_sets.at("sites"), sorted({body.response.node[1], body.response.node[2]}));
  std::vector<std::int32_t> boundary;
  for (const Triangle& t : body.boundary) boundary.insert(boundary.end(), t.begin(), t.end());
  EXPECT_EQ(read.node_sets.at("boundary"), sorted(boundary));
}

TEST(MeshFile, EveryFormatComesBack) {
  for (const char* file : {"meshio/body.inp", "gmsh/ball_41.msh"})
    for (const Format& format : kFormats) expect_round_trip(body_of(file), format);
}

TEST(MeshFile, NamesOfOtherLettersComeBackWhereTheFormatHasThem) {
  Body body = body_of("gmsh/body_41.msh");
  body.region_names = {"left & <right>", "Le\xc3\xb6n", "a b"};
  for (const Format& format : kFormats) {
    if (format.name == std::string("inp")) continue;
    expect_round_trip(body, format);
  }
}

TEST(MeshFile, CalculixGetsFieldsOfAtMostTwentyCharacters) {
  const std::string text = abaqus_mesh(body_of("gmsh/ball_41.msh"));
  for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1) {
    end = std::min(text.find_first_of(",\n", at), text.size());
    if (text[at] != '*') {
      EXPECT_LE(end - at, 21U) << text.substr(at, end - at);  // with a blank
    }
  }
}

TEST(MeshFile, NamesForCalculixHaveLettersAndDigitsAndDiffer) {
  Body body = body_of("gmsh/body_41.msh");
  body.region_names = {"a b", "A-B", "3 fixed"};
  const std::string text = abaqus_mesh(body);
  for (const char* line : {"ELSET=a_b\n", "ELSET=A_B_2\n", "ELSET=R3_fixed\n", "NSET=fixed\n"})
    EXPECT_THAT(text, testing::HasSubstr(line));
}

TEST(MeshFile, SurfaceReadsBackWithTheVerticesOfTheLibrary) {
  Body body = body_of("gmsh/ball_41.msh");
  body.response.node = {3, 1, 0, 2};
  body.response.triangles = {{0, 1, 2}, {2, 3, 0}};
  body.nodes[3] = {0.1, -1.0 / 3, 1e-7};
  const mesher::Soup soup = mesher::read_off(off_surface(body), "surface.off");
  ASSERT_EQ(soup.points.size(), 4U);
  for (std::size_t v = 0; v < 4; ++v)
    EXPECT_EQ(soup.points[v], body.nodes[to_index(body.response.node[v])]);
  EXPECT_EQ(soup.polygons, (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {2, 3, 0}}));
}

}  // namespace
}  // namespace palpate::app
