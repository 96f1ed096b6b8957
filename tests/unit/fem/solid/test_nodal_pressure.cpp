// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/nodal_pressure.hpp"

#include <gtest/gtest.h>

#include <random>

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

/// Elements beyond the free nodes contribute to the dilatation around the outermost ones.
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

}  // namespace
}  // namespace palpate::fem
