// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/read_febio.hpp"

#include <array>
#include <set>

#include "mesher/read/file/file.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

std::string spec(const std::string& version, const std::string& mesh) {
  return "<?xml version=\"1.0\"?>\n<febio_spec version=\"" + version + "\">\n" + mesh +
         "</febio_spec>\n";
}
const std::string kNodes =
    "<Nodes name=\"all\">\n<node id=\"1\">0,0,0</node>\n<node id=\"2\">1, 0, 0</node>\n"
    "<node id=\"3\">0,1,0</node>\n<node id=\"5\">0,0,1</node>\n<node id=\"8\">1,1,1</node>\n"
    "</Nodes>\n";

TEST(ReadFebio, ReadsFormat25) {
  const MeshEntities mesh = read_febio(
      spec("2.5",
           "<Material><material id=\"2\" name=\"fat\" type=\"neo-Hookean\"/></Material><Geometry>" +
               kNodes +
               "<Elements type=\"tet4\" mat=\"1\" name=\"part\"><elem "
               "id=\"1\">1,2,3,5</elem></Elements>"
               "<Elements type=\"tet4\" mat=\"2\"><elem id=\"2\">2,3,5,8</elem></Elements>"
               "<NodeSet name=\"held\"><node id=\"1\"/><node id=\"8\"/></NodeSet>"
               "<NodeSet name=\"more\"><NodeSet node_set=\"held\"/></NodeSet>"
               "<Surface name=\"top\"><tri3 id=\"1\">1,2,3</tri3></Surface></Geometry>"),
      "a.feb");
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"part", "fat"}));
  EXPECT_EQ(mesh.node_sets.at("held"), (std::vector<std::int32_t>{0, 4}));
  EXPECT_EQ(mesh.node_sets.at("more"), (std::vector<std::int32_t>{0, 4}));
  EXPECT_EQ(mesh.node_sets.at("top"), (std::vector<std::int32_t>{0, 1, 2}));
}

TEST(ReadFebio, ReadsFormats3And4) {
  const std::string elements =
      "<Elements type=\"tet4\" name=\"part\"><elem id=\"1\">1,2,3,5</elem>"
      "<elem id=\"2\">2,3,5,8</elem></Elements>";
  const MeshEntities three =
      read_febio(spec("3.0", "<Mesh>" + kNodes + elements +
                                 "<NodeSet name=\"held\"><n id=\"1\"/><n id=\"8\"/></NodeSet>"
                                 "<ElementSet name=\"second\"><e id=\"2\"/></ElementSet></Mesh>"),
                 "a.feb");
  const MeshEntities four =
      read_febio(spec("4.0", "<Mesh>" + kNodes + elements +
                                 "<NodeSet name=\"held\">1,\n8</NodeSet>"
                                 "<ElementSet name=\"second\">2</ElementSet></Mesh>"),
                 "a.feb");
  for (const MeshEntities& mesh : {three, four}) {
    EXPECT_EQ(mesh.node_sets.at("held"), (std::vector<std::int32_t>{0, 4}));
    EXPECT_EQ(mesh.node_sets.at("second"), (std::vector<std::int32_t>{1, 2, 3, 4}));
    EXPECT_EQ(mesh.groups.at("second"), (std::vector<std::int32_t>{1}));
    EXPECT_EQ(mesh.tetrahedra.size(), 2U);
  }
}

/// A box of 4.95665 x 4.52124 x 0.704593 from the origin, with sets of nodes and faces for its
/// sides. febio-python wrote the file, to which FEBio is the reader.
TEST(ReadFebio, ReadsABoxOfAnotherProgram) {
  const std::filesystem::path file = test::mesh_file("febio_python/plate.feb");
  const std::array<double, 3> size{4.95665, 4.52124, 0.704593};
  const VolumeMesh mesh = test::read_file("febio_python/plate.feb");
  EXPECT_EQ(mesh.nodes.size(), 1403U);
  EXPECT_EQ(mesh.region_names, std::vector<std::string>{"SMGNN_BENCHMARK"});
  EXPECT_NEAR(test::region_sizes(mesh).at("SMGNN_BENCHMARK").volume, size[0] * size[1] * size[2],
              1e-6);
  const MeshEntities raw = read_febio(read_bytes(file), "plate.feb");
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      std::string side = std::string(1, "XYZ"[axis]) + (upper ? "P" : "N");
      std::vector<std::int32_t> on_side;
      for (std::size_t n = 0; n < raw.nodes.size(); ++n)
        if (raw.nodes[n][axis] == (upper ? size[axis] : 0))
          on_side.push_back(static_cast<std::int32_t>(n));
      EXPECT_EQ(raw.node_sets.at(side + "_NODES"), on_side);
      const auto& corners = raw.node_sets.at(side + "_FACES");  // of every face
      EXPECT_EQ(std::set(corners.begin(), corners.end()), std::set(on_side.begin(), on_side.end()));
    }
}

TEST(ReadFebio, NamesTheLineOfAFault) {
  const auto refused = [](const std::string& bytes, const std::string& where,
                          const std::string& problem) {
    expect_refusal([&] { read_febio(bytes, "a.feb"); }, where, problem);
  };
  refused("<a></b>", "a.feb:1", "XML is damaged");
  refused("<a/>", "a.feb", "no febio_spec");
  refused(spec("1.2", ""), "a.feb:2", "version '1.2'");
  refused(spec("4.0", "<Mesh>\n<Nodes>\n<node id=\"1\">0,0</node></Nodes></Mesh>"), "a.feb:5",
          "2 coordinates");
  refused(spec("4.0", "<Mesh>\n<Nodes>\n<node id=\"1\">0,0,x</node></Nodes></Mesh>"), "a.feb:5",
          "no number");
  refused(spec("4.0", "<Mesh>" + kNodes +
                          "<Elements type=\"tet4\" name=\"a\">\n<elem id=\"1\">1,2,3,4</elem>"
                          "</Elements></Mesh>"),
          "a.feb:11", "node 4");
  refused(spec("4.0", "<Mesh>" + kNodes +
                          "<Elements type=\"tet10\" name=\"a\">\n<elem id=\"1\">1,2,3,5</elem>"
                          "</Elements></Mesh>"),
          "a.feb:11", "has 4 nodes");
}

}  // namespace
}  // namespace palpate::mesher
