// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/self_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// A bar bent into an arc of `angle`: its ends meet when the arc is a full circle, and pass through
/// one another beyond.
Displacement bent(const QuadraticMesh& mesh, double length, double angle) {
  Displacement u(3, mesh.nodes());
  const double R = length / angle;
  for (int node = 0; node < mesh.nodes(); ++node) {
    const Eigen::Vector3d X = mesh.X.col(node);
    // A slight helix: nodes of one end shall not meet the edges of the other.
    const double phi = X[0] / R, r = R - X[2] + 1e-4 * phi, y = X[1] + 8e-5 * phi;
    u.col(node) = Eigen::Vector3d(r * std::sin(phi), y, R - r * std::cos(phi)) - X;
  }
  return u;
}

class Bar : public testing::Test {
 protected:
  QuadraticMesh mesh = make_quadratic_mesh(test::make_block(
      test::even(0, 0.06, 24), test::even(-0.004, 0.004, 3), test::even(-0.003, 0.003, 2)));
};

TEST_F(Bar, EndsOfARingMeetAtAFullCircle) {
  const SelfContact watch(mesh, Eigen::Vector3d(0.03, 0, 0), 1);
  for (const double part : {0.01, 0.5, 0.9, 0.99})
    EXPECT_EQ(watch.entering_node(bent(mesh, 0.06, part * 2 * M_PI)), -1) << part;
  const int node = watch.entering_node(bent(mesh, 0.06, 1.02 * 2 * M_PI));
  ASSERT_GE(node, 0);
  const double X = mesh.X(0, node);
  EXPECT_TRUE(X < 0.003 || X > 0.057) << X;  // at an end
}

TEST_F(Bar, EveryCornerOfAFacetIsWatched) {
  const Displacement u = bent(mesh, 0.06, 1.02 * 2 * M_PI);
  const Eigen::Vector3d middle(0.03, 0, 0);
  const int node = SelfContact(mesh, middle, 1).entering_node(u);
  ASSERT_GE(node, 0);
  for (std::size_t place = 0; place < 3; ++place) {
    for (Facet& facet : mesh.facets)
      while (std::count(facet.begin(), facet.begin() + 3, node) > 0 && facet[place] != node)
        std::rotate(facet.begin(), facet.begin() + 1, facet.begin() + 3);
    EXPECT_EQ(SelfContact(mesh, middle, 1).entering_node(u), node) << place;
  }
}

TEST_F(Bar, OutOfReachIsNotWatched) {
  const SelfContact watch(mesh, Eigen::Vector3d(0.03, 0, 0), 0.01);
  EXPECT_EQ(watch.entering_node(bent(mesh, 0.06, 1.02 * 2 * M_PI)), -1);
}

}  // namespace
}  // namespace palpate::fem
