// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies of meshes that other programs made.
#include <cmath>
#include <numbers>

#include "mesher/mesher.hpp"
#include "tests/unit/mesher/body_checks.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

Settings settings_of(const std::string& file) {
  Settings s;
  s.volume_mesh = {test::mesh_file(file), test::kMillimetre, "", {}};
  s.patch_spacing = 0.010;
  s.tool_radius = 0.002;
  return s;
}

TEST(VolumeMeshBody, KeepsElementsAndRegionsAndIsFixedByItsGroups) {
  Settings s = settings_of("gmsh/body_41.msh");
  s.supports = {LabelSupport{"base"}};
  const Body body = mesh(s);
  test::expect_sound(body);
  EXPECT_EQ(body.tetrahedra.size(), 565U);
  EXPECT_EQ(body.fixed_nodes.size(), 43U);
  for (const std::int32_t node : body.fixed_nodes)
    EXPECT_EQ(body.nodes[static_cast<std::size_t>(node)][2], 0);
  ASSERT_THAT(body.region_names,
              testing::UnorderedElementsAre("left half", "right half", "nodule"));
  for (std::size_t r = 0; r < 3; ++r) {
    const double wanted = body.region_names[r] == "nodule"      ? 615.542323e-9
                          : body.region_names[r] == "left half" ? 11384.457677e-9
                                                                : 12000e-9;
    EXPECT_NEAR(test::volume_of_region(body, static_cast<std::int32_t>(r)), wanted, 1e-13);
  }
  EXPECT_LT(body.response.node.size(), 160U);  // a coarsening of the boundary
}

TEST(VolumeMeshBody, PressZonesAndInvertedSelectorsAddUp) {
  Settings s = settings_of("gmsh/body_41.msh");
  s.supports = {LabelSupport{"base"}};
  s.all_nodes_are_sites = true;
  // The top, and everything but x < 35 mm.
  s.press = {PlaneSupport{{0, 0, 0.0199}, {0, 0, 1}},
             Zone(PlaneSupport{{0.035, 0, 0}, {-1, 0, 0}}, true)};
  const Body body = mesh(s);
  std::size_t sites = 0;
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    if (body.response.is_site[v] == 0) continue;
    ++sites;
    const Vec3& x = body.nodes[static_cast<std::size_t>(body.response.node[v])];
    EXPECT_TRUE(x[2] > 0.0199 || x[0] > 0.035) << x[0] << " " << x[2];
  }
  EXPECT_GT(sites, 20U);
}

TEST(VolumeMeshBody, InvertedSupportsFixEverythingElse) {
  Settings s = settings_of("gmsh/body_41.msh");
  s.supports = {Zone(PlaneSupport{{0, 0, 0.001}, {0, 0, 1}}, true)};
  const Body body = mesh(s);
  EXPECT_EQ(body.fixed_nodes.size(), 43U);
}

TEST(VolumeMeshBody, QuadraticMeshesKeepTheirCurvedSkin) {
  Settings s = settings_of("gmsh/ball_41.msh");
  s.supports = {PlaneSupport{{0, 0, -4e-3}, {0, 0, -1}}};
  s.patch_spacing = 0.006;
  const Body body = mesh(s);
  EXPECT_EQ(body.curved_edges.size(), 3 * body.boundary.size() / 2);
  for (const CurvedEdge& edge : body.curved_edges)
    EXPECT_NEAR(norm(edge.middle - Vec3{1e-3, 2e-3, 3e-3}), 10e-3, 1e-9);
  s.curved_facets = false;
  EXPECT_TRUE(mesh(s).curved_edges.empty());
}

TEST(VolumeMeshBody, ASegmentationBecomesABodyOfItsRegions) {
  Settings s;
  s.image = {test::mesh_file("images/ball_sform.nii.gz"), 0, {{1, "soft"}, {5, "stiff"}}};
  s.patch_spacing = 0.004;
  s.element_size = 0.002;
  s.tool_radius = 0.001;
  s.supports = {PlaneSupport{{0, 0, 0.0155}, {0, 0, -1}}};
  const Body body = mesh(s);
  test::expect_sound(body);
  ASSERT_EQ(body.region_names.size(), 2U);
  // 246 and 17 voxels of 7.5 mm^3; the smoothing takes the corners of the steps off.
  EXPECT_NEAR(test::volume_of_region(body, -1), 263 * 7.5e-9, 0.1 * 263 * 7.5e-9);
  Settings by_label = s;
  by_label.supports = {LabelSupport{"soft"}};
  by_label.press = {};
  test::expect_refusal([&] { mesh(by_label); }, "ball_sform", "", "");
}

TEST(VolumeMeshBody, NamesTheSetsWhereALabelIsUnknown) {
  Settings s = settings_of("gmsh/body_41.msh");
  s.supports = {LabelSupport{"bone"}};
  test::expect_refusal([&] { mesh(s); }, "body_41.msh", "no set 'bone'", "'base'");
}

}  // namespace
}  // namespace palpate::mesher
