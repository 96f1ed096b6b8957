// SPDX-License-Identifier: AGPL-3.0-or-later
// The elements by their dilatation, as the model of a body treats them.
#include "fem/solid/dilatation.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "fem/solid/solid_model.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr Dilatation kAll[] = {Dilatation::Mean, Dilatation::Nodal, Dilatation::Pointwise,
                               Dilatation::LinearNodal};
constexpr double kMu = 3e3, kKappa = 3e5;  // Pa, nu = 0.495

class Dilatations : public testing::Test {
 protected:
  SolidModel model(Dilatation dilatation) const {
    return {body, {NeoHookean::from_moduli(kMu, kKappa)}, dilatation};
  }
  /// Displacement of every node by a function of its position at rest.
  template <class Map>
  static Displacement displaced(const SolidModel& model, const Map& map) {
    Displacement u(3, model.mesh().nodes());
    for (int node = 0; node < model.mesh().nodes(); ++node) {
      const Eigen::Vector3d X = model.mesh().X.col(node);
      u.col(node) = map(X);
    }
    return u;
  }
  const Body body = test::make_block(test::even(-0.02, 0.02, 4), test::even(-0.01, 0.01, 2),
                                     test::even(-0.02, 0, 2));
};

TEST_F(Dilatations, HaveNamesOfTheirOwnThatSayWhichNodesTheyHave) {
  std::set<std::string> names;
  for (const Dilatation each : kAll) {
    const std::string name = name_of(each);
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(name.rfind(is_linear(each) ? "Tet4," : "Tet10,", 0), 0u) << name;
  }
}

/// A patch test: where det F is the same everywhere, every mean of it is, and the energy is
/// V (mu/2 (J^{-2/3} I1 - 3) + kappa/4 (J^2 - 1 - 2 ln J)).
TEST_F(Dilatations, DoNotMatterInAHomogeneousDeformation) {
  Eigen::Matrix3d F;
  F << 1.1, 0.2, -0.05, 0.03, 0.9, 0.1, 0, -0.1, 1.05;
  const double J = F.determinant(), volume = 0.04 * 0.02 * 0.02;
  const double expected = volume * (0.5 * kMu * (std::pow(J, -2.0 / 3) * F.squaredNorm() - 3) +
                                    0.25 * kKappa * (J * J - 1 - 2 * std::log(J)));
  for (const Dilatation each : kAll) {
    const SolidModel m = model(each);
    const auto u = displaced(m, [&](const Eigen::Vector3d& X) {
      return Eigen::Vector3d((F - Eigen::Matrix3d::Identity()) * X);
    });
    EXPECT_NEAR(m.energy(u).energy, expected, 1e-10 * expected) << name_of(each);
  }
}

/// The penalty is convex: by Jensen's inequality a mean of det F costs no more than det F itself.
/// Much less in bending, which is why the pure displacement element locks.
TEST_F(Dilatations, MeansCostLessThanTheDilatationAtEveryPoint) {
  const auto bent = [](const Eigen::Vector3d& X) {
    constexpr double kCurvature = 10;  // 1/m
    return Eigen::Vector3d(kCurvature * X[0] * X[2], 0, -0.5 * kCurvature * X[0] * X[0]);
  };
  const auto energy = [&](Dilatation each) {
    const SolidModel m = model(each);
    return m.energy(displaced(m, bent)).energy;
  };
  const double pointwise = energy(Dilatation::Pointwise);
  EXPECT_LT(energy(Dilatation::Mean), 0.999 * pointwise);
  EXPECT_LT(energy(Dilatation::Nodal), 0.999 * pointwise);
}

}  // namespace
}  // namespace palpate::fem
