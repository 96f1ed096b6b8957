// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/prolongation.hpp"

#include <gtest/gtest.h>

#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

class Prolongations : public testing::Test {
 protected:
  Body body =
      test::make_block(test::even(0, 0.02, 3), test::even(0, 0.02, 3), test::even(0, 0.02, 3));
  SolidModel coarse{body, {NeoHookean::from_young_poisson(10e3, 0.45, "t")}};
  RefinedMesh refined = refine_elements(coarse.mesh(), {40, 41, 42, 77});
  SolidModel fine = SolidModel::without_stiffness(coarse, refined.mesh);
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

}  // namespace
}  // namespace palpate::fem
