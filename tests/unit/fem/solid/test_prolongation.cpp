// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/prolongation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

class Prolongations : public testing::Test {
 protected:
  Body body =
      test::make_block(test::even(0, 0.02, 3), test::even(0, 0.02, 3), test::even(0, 0.02, 3));
  SolidModel coarse{body, {NeoHookean::from_young_poisson(10e3, 0.45, "t")}};
  RefinedMesh refined = refine_elements(coarse.mesh(), {40, 41, 42, 77});
  SolidModel fine = SolidModel::without_stiffness(coarse, refined);
  Prolongation prolongation{refined, coarse.mesh().tetrahedra, fine};
};

/// Quadratic fields that vanish at the fixed base are the same functions on both meshes.
TEST_F(Prolongations, ReproduceQuadraticFields) {
  const auto field = [](const Eigen::Vector3d& X) {
    return Eigen::Vector3d(X[2] * X[0], X[2] * (1 + X[1]), X[2] * X[2]);
  };
  Eigen::VectorXd d(coarse.pattern().n);
  for (int node = 0; node < coarse.mesh().nodes(); ++node)
    if (coarse.equation(node) >= 0)
      d.segment<3>(coarse.equation(node)) = field(coarse.mesh().X.col(node));
  const Eigen::VectorXd all = prolongation.extended(d);
  ASSERT_GT(all.size(), d.size());
  for (int node = 0; node < fine.mesh().nodes(); ++node)
    if (fine.equation(node) >= 0) {
      EXPECT_LT((all.segment<3>(fine.equation(node)) - field(fine.mesh().X.col(node))).norm(),
                1e-15);
    }
}

TEST_F(Prolongations, ReduceByTheTranspose) {
  const Eigen::VectorXd d = Eigen::VectorXd::Random(coarse.pattern().n),
                        f = Eigen::VectorXd::Random(fine.pattern().n);
  EXPECT_NEAR(prolongation.reduced(f).dot(d), f.dot(prolongation.extended(d)), 1e-10);
}

/// A body on springs under its weight, all of whose energies are those of its elements where the
/// displacement is linear.
TEST(RefinedModel, HasTheWeightAndTheSpringsOfTheBody) {
  Body body =
      test::make_block(test::even(0, 0.02, 3), test::even(0, 0.02, 3), test::even(0, 0.02, 3));
  body.fixed_nodes.clear();
  for (std::size_t f = 0; f < body.boundary.size(); ++f)
    if (std::ranges::all_of(body.boundary[f],
                            [&](int node) { return body.nodes[to_index(node)][2] == 0; }))
      body.foundation.push_back({static_cast<std::int32_t>(f), 3e5, 1e5});
  const SolidModel coarse(body, {NeoHookean::from_young_poisson(10e3, 0.45, "t")}, Dilatation::Mean,
                          {{1, 2, -9.81}, 1000});
  std::vector<int> at_base;
  for (int e = 0; e < 40; ++e) at_base.push_back(e);
  const RefinedMesh refined = refine_elements(coarse.mesh(), at_base);
  ASSERT_GT(refined.mesh.sprung.size(), coarse.mesh().sprung.size());
  const SolidModel fine = SolidModel::without_stiffness(coarse, refined);
  Eigen::Matrix3d gradient;
  gradient << 0.02, 0.01, -0.03, 0.0, -0.04, 0.02, 0.05, 0.01, -0.02;
  const auto field = [&](const SolidModel& model) -> Displacement {
    return (gradient * model.mesh().X).colwise() + Eigen::Vector3d(1e-3, -2e-3, 5e-4);
  };
  const Displacement u = field(coarse), v = field(fine);
  const SolidModel::State a = coarse.energy(u), b = fine.energy(v);
  EXPECT_NEAR(a.energy, b.energy, 1e-12 * std::abs(a.energy));
  EXPECT_NEAR(a.volume, b.volume, 1e-12 * a.volume);
  Eigen::VectorXd f, g;
  coarse.forces(u, f);
  fine.forces(v, g);
  const Prolongation prolongation(refined, coarse.mesh().tetrahedra, fine);
  EXPECT_LT((prolongation.reduced(g) - f).norm(), 1e-12 * f.norm());
}

}  // namespace
}  // namespace palpate::fem
