// SPDX-License-Identifier: AGPL-3.0-or-later
// Pressures shared around corner nodes, and the measure of checkerboards.
#include <gtest/gtest.h>

#include <random>

#include "fem/solid/pressure_smoothness.hpp"
#include "fem/solid/solid_model.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

Body block() {
  Body body =
      test::make_block(test::even(0, 0.02, 4), test::even(0, 0.02, 4), test::even(0, 0.02, 4));
  body.region_names = {"tissue", "nodule"};
  for (std::size_t e = 0; e < body.tetrahedra.size(); e += 5) body.tetrahedron_region[e] = 1;
  return body;
}

class NodalPressures : public testing::TestWithParam<Dilatation> {};

/// The elements beyond the free nodes take part in the dilatation around the nodes at the edge.
TEST_P(NodalPressures, OfAWindowHaveTheForcesAndTheStiffnessOfTheWhole) {
  const Body body = block();
  const SolidModel whole(body,
                         {NeoHookean::from_young_poisson(10e3, 0.499, "tissue"),
                          NeoHookean::from_young_poisson(30e3, 0.49, "nodule")},
                         GetParam());
  const SolidModel window(whole, Eigen::Vector3d(0.01, 0.01, 0.02), 0.006);
  ASSERT_LT(window.pattern().n, whole.pattern().n / 3);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> entry(-2e-4, 2e-4);
  Displacement u = Displacement::Zero(3, whole.mesh().nodes());
  for (int node = 0; node < whole.mesh().nodes(); ++node)
    if (whole.mesh().is_free(node))
      u.col(node) = Eigen::Vector3d(entry(random), entry(random), entry(random));
  Eigen::VectorXd all, part;
  whole.forces(u, all);
  window.forces(u, part);
  std::vector<double> K_all, K_part;
  whole.stiffness(u, K_all);
  window.stiffness(u, K_part);
  const double largest = *std::max_element(K_all.begin(), K_all.end());
  for (int node = 0; node < whole.mesh().nodes(); ++node) {
    const int own = window.equation(node), same = whole.equation(node);
    if (own < 0) continue;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(part[own + i], all[same + i], 1e-9 * all.norm());
      EXPECT_NEAR(K_part[to_index(window.pattern().position(own + i, own))],
                  K_all[to_index(whole.pattern().position(same + i, same))], 1e-9 * largest);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, NodalPressures,
                         testing::Values(Dilatation::Nodal, Dilatation::LinearNodal));

TEST(SmoothPressure, LeavesAConstantAndFlattensAlternatingPressures) {
  Body body = block();
  body.tetrahedron_region.assign(body.tetrahedra.size(), 0);
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  const std::vector<double> constant(mesh.tetrahedra.size(), 5);
  const SmoothPressure same = smooth_pressure(mesh, constant);
  for (const double p : same.pressure) EXPECT_NEAR(p, 5, 1e-12);
  std::vector<double> alternating;
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e)
    alternating.push_back(e % 2 == 0 ? 1 : -1);
  const SmoothPressure flat = smooth_pressure(mesh, alternating);
  EXPECT_GT(flat.roughness, 0.9);
  EXPECT_GT(flat.alternation, kAlternating);
}

/// Its only change to a linear field is at the boundary, where a node has elements on one side.
TEST(SmoothPressure, IsNearALinearField) {
  Body body = block();
  body.tetrahedron_region.assign(body.tetrahedra.size(), 0);
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  std::vector<double> linear;
  for (const auto& t : mesh.tetrahedra) {
    double x = 0;
    for (std::size_t c = 0; c < 4; ++c) x += 0.25 * mesh.X(0, t[c]);
    linear.push_back(x);
  }
  EXPECT_LT(smooth_pressure(mesh, linear).roughness, 0.2);
}

/// A jump between regions is the body's, not a checkerboard.
TEST(SmoothPressure, KeepsAJumpBetweenRegions) {
  const Body body = block();
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  std::vector<double> jump;
  for (const auto region : mesh.region) jump.push_back(region == 0 ? 1 : 3);
  EXPECT_LT(smooth_pressure(mesh, jump).roughness, 1e-12);
}

}  // namespace
}  // namespace palpate::fem
