// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies under their own weight.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/factor/cholesky.hpp"
#include "fem/laws/law_table.hpp"
#include "fem/solve/preload.hpp"
#include "tests/support/heavy_rod.hpp"
#include "tests/verification/record.hpp"

namespace palpate::fem {
namespace {

using test::Reference;

constexpr double kGravity = 9.81;

/// The silicone rod of [Mazier et al. 2022], whose sag is printed in the tests of SOFA.
struct Rod {
  double radius = 0.00425, length = 0.182, density = 965;
  double C10 = 151065.46, C01 = 101709.668, bulk = 1e7;  ///< Pa
  double mu() const { return 2 * (C10 + C01); }
  double young() const { return 9 * bulk * mu() / (3 * bulk + mu()); }
  double area() const { return M_PI * radius * radius; }
  LawConstants law() const {
    return {"mooney-rivlin", {{"C10", C10}, {"C01", C01}, {"poisson", young() / (2 * mu()) - 1}}};
  }
};

constexpr int kLayers = 40;

Eigen::Vector3d tip_of(const Rod& rod, const Vec3& acceleration) {
  const Body body = test::make_rod(rod.radius, rod.length, kLayers);
  const SolidModel model(body, {make_law(rod.law(), "t")}, Dilatation::Mean,
                         Gravity{acceleration, rod.density});
  const Displacement u =
      equilibrium_under_weight(model, nested_dissection(model.pattern()), body.name);
  const int tip = static_cast<int>(body.nodes.size()) - 19;  // the middle of the last layer
  return model.mesh().X.col(tip) + u.col(tip);
}

const char* const kProblem = "A clamped rod of silicone under its own weight";

TEST(GravityOnARod, BendsItLikeTheElasticaAndTheMeasuredRod) {
  const Rod rod;
  const Eigen::Vector3d tip = tip_of(rod, {0, -kGravity, 0});
  const test::RodTip theory =
      test::heavy_elastica(rod.density * kGravity * rod.area(),
                           rod.young() * M_PI / 4 * std::pow(rod.radius, 4), rod.length, M_PI / 2);
  const std::string source = "inextensible elastica, integrated in the test";
  test::verify({kProblem, "level clamp, sag of the tip", "mm", -1e3 * tip[1], 1e3 * theory.along,
                Reference::OtherSolver, source, 0.005});
  test::verify({kProblem, "level clamp, distance of the tip from the clamp", "mm", 1e3 * tip[2],
                1e3 * theory.across, Reference::OtherSolver, source, 0.005});
  test::verify({kProblem, "level clamp, sag of the tip, measured", "mm", -1e3 * tip[1], 116.25,
                Reference::Published,
                "SOFA, TetrahedronHyperelasticityFEMForceField_test; experiment of Mazier et al. "
                "2022",
                0.04});
}

TEST(GravityOnARod, SagsLikeABeamWhereTheSagIsSmall) {
  const Rod rod;
  constexpr double kPart = 0.01;
  const double q = kPart * rod.density * kGravity * rod.area();
  const double bending = rod.young() * M_PI / 4 * std::pow(rod.radius, 4);
  test::verify({kProblem, "level clamp, a hundredth of the weight, sag of the tip", "mm",
                -1e3 * tip_of(rod, {0, -kPart * kGravity, 0})[1],
                1e3 * q * std::pow(rod.length, 4) / (8 * bending), Reference::ClosedForm,
                "q L^4/(8 E I), Euler and Bernoulli", 0.005});
}

/// The clamp takes no lateral contraction, which shortens its part of the rod by little.
TEST(GravityOnARod, StretchesItWhereItHangs) {
  const Rod rod;
  test::verify({kProblem, "hanging, elongation", "mm",
                1e3 * (tip_of(rod, {0, 0, kGravity})[2] - rod.length),
                1e3 * rod.density * kGravity * rod.length * rod.length / (2 * rod.young()),
                Reference::ClosedForm, "rho g L^2/(2 E)", 0.01});
}

}  // namespace
}  // namespace palpate::fem
