// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/tool_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "format/to_index.hpp"

namespace palpate::fem {
namespace {

class ToolMeshes : public testing::TestWithParam<ToolGeometry> {
 protected:
  Tool tool() const {
    const Eigen::Vector3d inward = Eigen::Vector3d(0.2, -0.1, -1).normalized();
    return {GetParam(), Eigen::Vector3d(0.01, 0.02, 0.03), inward, inward.unitOrthogonal()};
  }
};

/// Zero on the tool. The distance to a sharp disc jumps at its edge.
double off(const Tool& t, const Eigen::Vector3d& x) {
  if (!t.has_sharp_edge()) return t.distance(x);
  return std::max(t.beyond_end(x), t.from_axis(x) - t.geometry.radius);
}

TEST_P(ToolMeshes, HaveEveryNodeOfAFacetOnTheTool) {
  const Tool t = tool();
  const ToolMesh mesh = make_tool_mesh(t, 0.01);
  ASSERT_GT(mesh.tetrahedra.size(), 50u);
  for (const Tetrahedron10& element : mesh.tetrahedra)
    for (const std::size_t node : {0u, 1u, 2u, 4u, 5u, 6u})
      EXPECT_NEAR(off(t, mesh.X.col(element[node])), 0, 1e-9 * 0.005);
}

TEST_P(ToolMeshes, HaveElementsOfPositiveVolume) {
  const ToolMesh mesh = make_tool_mesh(tool(), 0.01);
  for (const Tetrahedron10& element : mesh.tetrahedra) {
    const auto edge = [&](std::size_t c) -> Eigen::Vector3d {
      return mesh.X.col(element[c]) - mesh.X.col(element[0]);
    };
    EXPECT_GT(edge(1).cross(edge(2)).dot(edge(3)), 0);
  }
}

TEST_P(ToolMeshes, HaveTheirMiddleNodesHalfwayAlongTheEdges) {
  const ToolMesh mesh = make_tool_mesh(tool(), 0.01);
  for (const Tetrahedron10& element : mesh.tetrahedra)
    for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
      const auto [i, j] = kTetEdges[e];
      const Eigen::Vector3d a = mesh.X.col(element[i]), b = mesh.X.col(element[j]);
      const Eigen::Vector3d middle = mesh.X.col(element[4 + e]);
      // On a curved surface they are lifted off the chord, by less than a quarter of it.
      EXPECT_LT((middle - 0.5 * (a + b)).norm(), 0.25 * (b - a).norm());
    }
}

TEST_P(ToolMeshes, ReachBackToTheirCentreOrAsFarAsAsked) {
  const Tool t = tool();
  const double side = 0.01;
  const ToolMesh mesh = make_tool_mesh(t, side);
  double height = 0;
  for (const Tetrahedron10& element : mesh.tetrahedra)
    for (const std::size_t node : {0u, 1u, 2u})
      height = std::max(height, (t.tip - mesh.X.col(element[node])).dot(t.inward));
  const bool disc = t.geometry.shape == ToolShape::Disc;
  EXPECT_NEAR(height, disc ? t.geometry.edge_radius + side : t.geometry.radius, 1e-12);
}

/// The tip is the first point that a body meets.
TEST_P(ToolMeshes, ReachTheTip) {
  const Tool t = tool();
  const ToolMesh mesh = make_tool_mesh(t, 0.01);
  double nearest = 1;
  for (const Tetrahedron10& element : mesh.tetrahedra)
    for (const std::size_t node : {0u, 1u, 2u}) {
      EXPECT_LE(t.beyond_end(mesh.X.col(element[node])), 1e-12);
      nearest = std::min(nearest, (mesh.X.col(element[node]) - t.tip).norm());
    }
  EXPECT_LT(nearest, 0.002);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ToolMeshes,
                         testing::Values(ToolGeometry{ToolShape::Sphere, 0.005, 0, 0},
                                         ToolGeometry{ToolShape::Disc, 0.005, 0.001, 0},
                                         ToolGeometry{ToolShape::Disc, 0.005, 0, 0},
                                         ToolGeometry{ToolShape::Cylinder, 0.005, 0, 0.01}),
                         [](const auto& instance) {
                           return std::string(instance.param.shape == ToolShape::Disc &&
                                                      instance.param.edge_radius == 0
                                                  ? "sharp_"
                                                  : "") +
                                  name_of(instance.param.shape);
                         });

}  // namespace
}  // namespace palpate::fem
