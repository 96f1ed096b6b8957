// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/history_stress.hpp"

#include <gtest/gtest.h>

#include <random>

#include "fem/solid/solid_model.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

class HistoryStresses : public testing::TestWithParam<Dilatation> {
 protected:
  HistoryStresses() {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> stress(-2e3, 2e3);
    step_.factor = {0.7};
    step_.stress.resize(elastic_.mesh().tetrahedra.size());
    for (auto& element : step_.stress)
      for (Stress& point : element)
        for (double& entry : point) entry = stress(random);
  }
  Displacement moved(double s) const {
    Displacement u = Displacement::Zero(3, elastic_.mesh().nodes());
    add_step(elastic_, 1, d_, u);
    add_step(elastic_, s, e_, u);
    return u;
  }

  Body body_ =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, 0.02, 2));
  SolidModel elastic_{body_, {NeoHookean::from_young_poisson(10e3, 0.45, "t")}, GetParam()};
  HistoryStress step_;
  SolidModel model_ = SolidModel::relaxing(elastic_, &step_);
  Eigen::VectorXd d_ = 1e-4 * Eigen::VectorXd::Random(elastic_.pattern().n),
                  e_ = 1e-4 * Eigen::VectorXd::Random(elastic_.pattern().n);
};

/// Central differences of the energy and the forces along a direction.
TEST_P(HistoryStresses, HaveForcesAndTangentOfTheirEnergy) {
  constexpr double h = 1e-3;
  Eigen::VectorXd f, high, low;
  const double up = model_.forces(moved(h), high).energy,
               down = model_.forces(moved(-h), low).energy;
  model_.forces(moved(0), f);
  EXPECT_NEAR(f.dot(e_), (up - down) / (2 * h), 1e-5 * f.norm() * e_.norm());
  std::vector<double> K;
  model_.stiffness(moved(0), K);
  Eigen::VectorXd Ke(e_.size());
  symmetric_multiply(model_.pattern(), K, e_.data(), Ke.data());
  EXPECT_LT((Ke - (high - low) / (2 * h)).norm(), 1e-5 * Ke.norm());
  EXPECT_DOUBLE_EQ(model_.energy(moved(0)).energy, model_.forces(moved(0), f).energy);
}

/// c S + H at the displacement where S was taken, with H = (1 - c) S: the elastic forces.
TEST_P(HistoryStresses, TheIsochoricStressAsHistoryReplacesTheLaw) {
  const Displacement u = moved(0);
  step_.stress = elastic_.isochoric_stress(u);
  for (auto& element : step_.stress)
    for (Stress& point : element)
      for (double& entry : point) entry *= 1 - step_.factor[0];
  Eigen::VectorXd f, elastic;
  model_.forces(u, f);
  elastic_.forces(u, elastic);
  EXPECT_LT((f - elastic).norm(), 1e-12 * elastic.norm());
}

TEST_P(HistoryStresses, WithoutFactorsAreTheElasticBody) {
  step_.factor.clear();
  Eigen::VectorXd f, elastic;
  EXPECT_EQ(model_.forces(moved(0), f).energy, elastic_.forces(moved(0), elastic).energy);
  EXPECT_EQ(f, elastic);
}

INSTANTIATE_TEST_SUITE_P(Elements, HistoryStresses,
                         testing::Values(Dilatation::Mean, Dilatation::Nodal, Dilatation::Pointwise,
                                         Dilatation::LinearNodal));

}  // namespace
}  // namespace palpate::fem
