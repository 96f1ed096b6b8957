// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/quadratic_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/equilibrium.hpp"

namespace palpate::fem {
namespace {

Body block() {
  return test::make_block(test::even(0, 0.02, 2), test::even(0, 0.03, 3), test::even(0, 0.02, 2));
}

/// Vertices - edges + faces - cells of a ball is 1.
TEST(QuadraticMesh, HasOneNodeForEachEdge) {
  const Body body = block();
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  const std::size_t cells = body.tetrahedra.size(), faces = (4 * cells + body.boundary.size()) / 2;
  EXPECT_EQ(mesh.corners(), static_cast<int>(body.nodes.size()));
  EXPECT_EQ(body.nodes.size() - mesh.edges.size() + faces - cells, 1u);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto [a, b] = mesh.edges[e];
    const Eigen::Vector3d middle = 0.5 * (mesh.X.col(a) + mesh.X.col(b));
    EXPECT_LT((mesh.X.col(mesh.corners() + static_cast<int>(e)) - middle).norm(), 1e-15);
  }
}

TEST(QuadraticMesh, FixesMidEdgeNodesOfFixedFacets) {
  const QuadraticMesh mesh = make_quadratic_mesh(block());
  for (int node = 0; node < mesh.nodes(); ++node) {
    EXPECT_EQ(mesh.fixed[to_index(node)], mesh.X(2, node) == 0) << mesh.X.col(node).transpose();
    EXPECT_EQ(mesh.is_free(node), mesh.X(2, node) > 0);
  }
}

TEST(QuadraticMesh, PutsMidEdgeNodesOfCurvedEdgesOnTheSurface) {
  Body body = block();
  const Triangle facet = body.boundary.front();
  const Vec3 middle{0.001, 0.002, -0.003};
  body.curved_edges.push_back(
      {{std::min(facet[0], facet[1]), std::max(facet[0], facet[1])}, middle});
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  EXPECT_EQ(mesh.X.col(mesh.facets.front()[3]), Eigen::Vector3d(middle.data()));
}

TEST(QuadraticMesh, OfLinearElementsMovesMidEdgeNodesWithTheirCorners) {
  const QuadraticMesh mesh = make_quadratic_mesh(block(), true);
  Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Random(3, mesh.nodes());
  const Eigen::Matrix3Xd before = u;
  straighten(mesh, u);
  EXPECT_EQ(u.leftCols(mesh.corners()), before.leftCols(mesh.corners()));
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto [a, b] = mesh.edges[e];
    const int node = mesh.corners() + static_cast<int>(e);
    EXPECT_EQ(u.col(node), 0.5 * (u.col(a) + u.col(b)));
    EXPECT_FALSE(mesh.is_free(node));
  }
}

/// A wall of one cell between two fixed faces, under its weight along them: in between
/// u = rho g x (w - x)/(2 mu), for a neo-Hookean solid at any strain if it moves only vertically.
/// The influence of its fixed rim decays like exp(-pi r/w).
TEST(QuadraticMesh, LeavesTheMiddleOfAWallBetweenFixedFacesFree) {
  constexpr double kWidth = 0.01, kSide = 0.12, kWeight = 9810;
  const NeoHookean law = NeoHookean::from_young_poisson(10e3, 0.3, "t");
  Body body = test::make_block(test::even(0, kWidth, 1), test::even(0, kSide, 12),
                               test::even(0, kSide, 12));
  body.fixed_nodes.clear();
  for (std::size_t i = 0; i < body.nodes.size(); ++i)
    body.fixed_nodes.push_back(static_cast<std::int32_t>(i));  // they all lie on the two faces
  const SolidModel model(body, {law});
  const QuadraticMesh& mesh = model.mesh();
  std::vector<test::Prescribed> sideways;
  for (int node = 0; node < mesh.nodes(); ++node)
    for (int i = 0; i < 2 && model.equation(node) >= 0; ++i)
      sideways.push_back({model.equation(node) + i, 0});
  Displacement u = Displacement::Zero(3, mesh.nodes());
  const auto weight = [](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 0, -kWeight); };
  test::equilibrate(model, test::body_loads(mesh, weight), sideways, u);
  const double middle = -kWeight * kWidth * kWidth / (8 * law.mu());
  int between = 0;
  for (int node = 0; node < mesh.nodes(); ++node) {
    const Eigen::Vector3d off = mesh.X.col(node) - Eigen::Vector3d(kWidth, kSide, kSide) / 2;
    if (std::max(std::abs(off[1]), std::abs(off[2])) > 0.6 * kWidth) continue;
    const bool in_the_middle = std::abs(off[0]) < 1e-9;
    between += in_the_middle ? 1 : 0;
    EXPECT_NEAR(u(2, node), in_the_middle ? middle : 0, 3e-3 * std::abs(middle));
  }
  EXPECT_GT(between, 5);
}

}  // namespace
}  // namespace palpate::fem
