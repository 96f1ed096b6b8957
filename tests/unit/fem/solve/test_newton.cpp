// SPDX-License-Identifier: AGPL-3.0-or-later
// Patch test: with the boundary of a distorted mesh moved affinely, the solved interior is affine
// and the energy is that of the homogeneous state.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <tuple>

#include "fem/laws/law_table.hpp"
#include "fem/solve/newton.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/sample_laws.hpp"
#include "tests/unit/fem/solve/pressed_body.hpp"

namespace palpate::fem {
namespace {

Body fixed_all_around() {
  Body body =
      test::make_block(test::even(0, 0.03, 3), test::even(0, 0.03, 3), test::even(0, 0.03, 3));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-2e-3, 2e-3);
  std::vector<bool> outside(body.nodes.size(), false);
  for (const auto& t : body.boundary)
    for (const auto node : t) outside[to_index(node)] = true;
  body.fixed_nodes.clear();
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    if (outside[i])
      body.fixed_nodes.push_back(static_cast<std::int32_t>(i));
    else
      body.nodes[i] = body.nodes[i] + Vec3{shift(random), shift(random), shift(random)};
  }
  return body;
}

class PatchTest : public testing::TestWithParam<std::tuple<LawConstants, Dilatation>> {};

TEST_P(PatchTest, AnAffineBoundaryGivesAnAffineInterior) {
  const Body body = fixed_all_around();
  const auto& [constants, dilatation] = GetParam();
  const Law law = make_law(constants, "t");
  const SolidModel model(body, {law}, dilatation);
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> F;
  F << 1.10, 0.20, -0.05, 0.00, 0.92, 0.10, 0.04, -0.03, 1.02;
  const Displacement affine = F * model.mesh().X - model.mesh().X;
  Displacement u = affine;
  std::mt19937 random(6);
  std::uniform_real_distribution<double> shift(-4e-5, 4e-5);
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (model.equation(node) >= 0)
      u.col(node) += Eigen::Vector3d(shift(random), shift(random), shift(random));

  const ToolContact far_away(model.mesh(), Eigen::Vector3d(1, 1, 1), 1e-6, {1, 1});
  NewtonSolver newton(model);
  NewtonOptions options;
  options.tolerance = 10;  // over a tool force of 1e-12 N: the residual is round-off
  const NewtonResult result = newton.solve(far_away, options, u);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_LT((u - affine).lpNorm<Eigen::Infinity>(), 1e-11);

  Tensor2<Lanes> t;
  for (int i = 0; i < 9; ++i) t[to_index(i)] = Lanes::Constant(F(i / 3, i % 3));
  Fibres<Lanes> a;
  const auto fibres = law.fibres_at({});
  for (std::size_t f = 0; f < 2; ++f)
    for (std::size_t i = 0; i < 3; ++i) a[f][i] = Lanes::Constant(fibres[f][i]);
  const Lanes J = Lanes::Constant(F.determinant());
  const double volume = std::pow(0.03, 3);
  const double density = law.psi(t, J, a)[0] + law.volumetric_energy(J)[0];
  EXPECT_NEAR(model.energy(u).energy, volume * density, 1e-12);
}

std::string instance_name(const testing::TestParamInfo<PatchTest::ParamType>& instance) {
  const auto& [constants, dilatation] = instance.param;
  std::string name = constants.law;
  if (dilatation == Dilatation::Nodal) name += "NodalPressure";
  if (dilatation == Dilatation::Pointwise) name += "Displacement";
  if (dilatation == Dilatation::LinearNodal) name += "Linear";
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(EveryLaw, PatchTest,
                         testing::Combine(testing::ValuesIn(test::sample_laws(0.49)),
                                          testing::Values(Dilatation::Mean, Dilatation::Nodal,
                                                          Dilatation::LinearNodal)),
                         instance_name);
INSTANTIATE_TEST_SUITE_P(PureDisplacement, PatchTest,
                         testing::Combine(testing::Values(test::sample_laws(0.45).front()),
                                          testing::Values(Dilatation::Pointwise)),
                         instance_name);

/// Newton steps back to the rest shape of a bar that was bent aside by a hundredth of its width.
/// Its elements are flat, or it bends a million times more easily than it stretches: with factors
/// in single precision alone it takes four times as many, or none is found.
int iterations_of_a_bar(double length, Precision fastest) {
  const Body body =
      test::make_block(test::even(0, 0.01, 1), test::even(0, 0.01, 1), test::even(0, length, 160));
  const SolidModel model(body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")});
  const ToolContact far_away(model.mesh(), Eigen::Vector3d(9, 9, 9), 1e-6, {1, 1});
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (model.equation(node) >= 0)
      u(0, node) = 1e-4 * std::pow(model.mesh().X(2, node) / length, 2);
  NewtonSolver newton(model, nullptr, nullptr, fastest);
  NewtonOptions options;
  options.tolerance = 0.3;  // over a tool force of 1e-12 N
  const NewtonResult result = newton.solve(far_away, options, u);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_LT(u.lpNorm<Eigen::Infinity>(), 1e-6 * length);
  return result.iterations;
}

TEST(NewtonInSinglePrecision, TakesNoMoreIterationsOfABarThanInDoublePrecision) {
  for (const double length : {0.1, 4.0})
    EXPECT_LE(iterations_of_a_bar(length, Precision::Single),
              iterations_of_a_bar(length, Precision::Double) + 1);
}

/// Steps to the equilibrium of a block under a sphere that is pressed in at once.
int iterations_of_a_press(double poisson, double depth) {
  PressedBody p(2 * kToolRadius, poisson);
  p.press(depth);
  Displacement u = p.rest();
  NewtonSolver newton(p.whole);
  const NewtonResult result = newton.solve(p.contact, {.tolerance = 1e-8}, u);
  EXPECT_TRUE(result.converged) << result.reason;
  return result.iterations;
}

/// With the pressures of the displaced elements in the tangent the nearly incompressible block
/// takes 6 to 11 steps more than the compressible one.
TEST(Newton, TakesFewMoreStepsOfANearlyIncompressibleBlock) {
  for (const double depth : {0.0015, 0.0025, 0.0035})
    EXPECT_LE(iterations_of_a_press(0.499, depth), iterations_of_a_press(0.3, depth) + 4) << depth;
}

}  // namespace
}  // namespace palpate::fem
