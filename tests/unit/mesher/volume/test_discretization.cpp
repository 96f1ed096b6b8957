// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/volume/discretization.hpp"

namespace palpate::mesher {
namespace {

constexpr double kFeatureAngle = std::numbers::pi / 4;

/// A block of n^3 cubes of edge 1/n, each divided into six tetrahedra around its diagonal.
VolumeMesh block(int n) {
  VolumeMesh mesh;
  const auto node = [&](int i, int j, int k) { return (i * (n + 1) + j) * (n + 1) + k; };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        mesh.nodes.push_back({double(i) / n, double(j) / n, double(k) / n});
  const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (const auto& order : orders) {
          int at[3] = {i, j, k};
          Tetrahedron t{node(i, j, k), 0, 0, 0};
          for (std::size_t step = 0; step < 3; ++step) {
            ++at[order[step]];
            t[step + 1] = node(at[0], at[1], at[2]);
          }
          if (volume(mesh.nodes, t) < 0) std::swap(t[2], t[3]);
          mesh.tetrahedra.push_back(t);
          mesh.region.push_back(i < n / 2 ? 0 : 1);
        }
  mesh.region_names = {"left", "right"};
  return mesh;
}

TEST(Discretization, BoundaryOfABlockEnclosesItsVolume) {
  const VolumeMesh mesh = block(4);
  const std::vector<Triangle> facets = boundary_of(mesh, "block");
  EXPECT_EQ(facets.size(), 6U * 4 * 4 * 2);
  EXPECT_NEAR(signed_volume({mesh.nodes, facets, {}, {}}), 1, 1e-12);
}

TEST(Discretization, ResponseVerticesComeFirstAndSetsFollowTheirNodes) {
  VolumeMesh mesh = block(8);
  mesh.node_sets["floor"] = {};
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    if (mesh.nodes[v][2] == 0) mesh.node_sets["floor"].push_back(static_cast<std::int32_t>(v));
  const auto interior = 7U * 7 * 7;
  const std::size_t nodes = mesh.nodes.size();
  const Discretization d = with_response(mesh, 0.3, kFeatureAngle, "block");

  EXPECT_EQ(d.volume.nodes.size(), nodes);
  EXPECT_EQ(d.skin.boundary.points.size(), nodes - interior);
  EXPECT_LT(d.skin.response.points.size(), d.skin.boundary.points.size() / 3);
  for (std::size_t v = 0; v < d.skin.response.points.size(); ++v)
    EXPECT_EQ(d.skin.response.points[v], d.volume.nodes[v]);
  for (std::size_t v = 0; v < d.skin.boundary.points.size(); ++v)
    EXPECT_EQ(d.skin.boundary.points[v], d.volume.nodes[v]);
  EXPECT_NEAR(signed_volume(d.skin.boundary), 1, 1e-12);
  EXPECT_NEAR(signed_volume(d.skin.response), 1, 1e-12);  // sharp edges stay

  const auto& floor = d.volume.node_sets.at("floor");
  EXPECT_EQ(floor.size(), 81U);
  for (const std::int32_t v : floor) EXPECT_EQ(d.volume.nodes[to_index(v)][2], 0);
  double left = 0;
  for (std::size_t t = 0; t < d.volume.tetrahedra.size(); ++t) {
    const double v = volume(d.volume.nodes, d.volume.tetrahedra[t]);
    EXPECT_GT(v, 0);
    if (d.volume.region[t] == 0) left += v;
  }
  EXPECT_NEAR(left, 0.5, 1e-12);
}

TEST(Discretization, WithoutASpacingEveryNodeOfTheBoundaryIsAResponseVertex) {
  const Discretization d = with_response(block(3), 0, kFeatureAngle, "block");
  EXPECT_EQ(d.skin.response.points.size(), 4U * 4 * 4 - 2U * 2 * 2);
  EXPECT_EQ(d.skin.response.triangles, d.skin.boundary.triangles);
}

TEST(Discretization, CurvedEdgesFollowTheirNodes) {
  VolumeMesh mesh = block(2);
  const Edge ends{0, 1};
  const Vec3 middle = 0.5 * (mesh.nodes[0] + mesh.nodes[1]) + Vec3{-0.01, 0, 0};
  mesh.curved_edges = {{ends, middle}};
  const Discretization d = with_response(mesh, 0, kFeatureAngle, "block");
  ASSERT_EQ(d.skin.curved.size(), 1U);
  const CurvedEdge& edge = d.skin.curved[0];
  EXPECT_LT(edge.ends[0], edge.ends[1]);
  const Vec3 straight =
      0.5 * (d.volume.nodes[to_index(edge.ends[0])] + d.volume.nodes[to_index(edge.ends[1])]);
  EXPECT_NEAR(norm(edge.middle - straight - Vec3{-0.01, 0, 0}), 0, 1e-12);
}

void expect_meets_itself(const VolumeMesh& mesh, const std::string& place) {
  try {
    boundary_of(mesh, "file.msh");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_EQ(error.where(), "file.msh");
    EXPECT_THAT(error.problem(), testing::HasSubstr(place));
    EXPECT_FALSE(error.remedy().empty());
  }
}

TEST(Discretization, RefusesTetrahedraThatMeetInAnEdgeOrANode) {
  VolumeMesh mesh;
  mesh.nodes = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  mesh.tetrahedra = {{0, 2, 3, 1}, {0, 4, 5, 1}};
  expect_meets_itself(mesh, "in 1 edge and 0 nodes, the first at (0, 0, 0) mm");

  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  expect_meets_itself(mesh, "in 0 edges and 1 node, the first at (0, 0, 0) mm");
}

}  // namespace
}  // namespace palpate::mesher
