// SPDX-License-Identifier: AGPL-3.0-or-later
// Every law against its own definition: automatic differentiation of its energy, rotations, and
// limits in which it becomes another law.
#include <gtest/gtest.h>

#include "fem/laws/law.hpp"
#include "tests/unit/fem/laws/law_samples.hpp"

namespace palpate::fem {
namespace {

template <class L>
class EveryLaw : public testing::Test {};

using Laws =
    testing::Types<NeoHookean, MooneyRivlin, MooneyRivlin5, Yeoh, Ogden, DemirayFung,
                   VerondaWestmann, Gent, ArrudaBoyce, SaintVenantKirchhoff, HolzapfelGasserOgden>;
TYPED_TEST_SUITE(EveryLaw, Laws);

TYPED_TEST(EveryLaw, RestIsStressFree) {
  const auto law = Sample<TypeParam>::make();
  for (const double p : stress(law, to_tensor(Matrix::Identity()))) EXPECT_NEAR(p, 0, 1e-10);
  EXPECT_NEAR(energy(law, to_tensor(Matrix::Identity())), 0, 1e-10);
}

TYPED_TEST(EveryLaw, SmallStrainModuliAreThoseOfTheTable) {
  const auto law = Sample<TypeParam>::make();
  for (const LawConstants& sample : test::sample_laws(kPoisson)) {
    if (sample.law != Sample<TypeParam>::kName) continue;
    const RestModuli rest = rest_moduli(sample);
    const double h = 1e-6;
    // A shear that is slack in every fibre to first order would be a special direction: the
    // tangent at rest itself, where fibres do not act yet, and a swelling that holds them slack.
    const Tensor4<double> A = isochoric_tangent(law, Matrix::Identity());
    EXPECT_NEAR(A[1][1], rest.mu(), 1e-6 * rest.mu());
    EXPECT_NEAR(A[5][7], rest.mu(), 1e-6 * rest.mu());
    const Matrix shrunk = (1 - h) * Matrix::Identity();
    EXPECT_NEAR(stress(law, to_tensor(shrunk))[0] / (-3 * h), rest.kappa(), 1e-4 * rest.kappa());
  }
}

TYPED_TEST(EveryLaw, StressIsTheDerivativeOfTheEnergy) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix F = random_gradient(random);
    const auto P = stress(law, to_tensor(F));
    const Varied W = energy(law, varied(F));
    const double scale = to_matrix(P).norm();
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(P[i], slope(W, i), 1e-9 * scale);
  }
}

TYPED_TEST(EveryLaw, TangentIsTheDerivativeOfTheStress) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix F = random_gradient(random);
    const Tensor4<double> A = isochoric_tangent(law, F);
    const Tensor2<Varied> P = isochoric_stress(law, varied(F));
    double scale = 0;
    for (const auto& row : A)
      for (const double entry : row) scale = std::max(scale, std::abs(entry));
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(A[i][k], slope(P[i], k), 1e-9 * scale);
  }
}

TYPED_TEST(EveryLaw, TangentHoldsWhereStretchesAreEqual) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(3);
  for (const auto& stretches : {Eigen::Vector3d(1.2, 1.2, 0.8), Eigen::Vector3d(0.9, 0.9, 0.9),
                                Eigen::Vector3d(1.1, 1.1 + 1e-7, 0.9)}) {
    // A swelling strains no fibre: that is where the tension switch acts.
    if (Anisotropic<TypeParam> && stretches[0] == stretches[2]) continue;
    const Matrix F = random_rotation(random) * stretches.asDiagonal() * random_rotation(random);
    const Tensor4<double> A = isochoric_tangent(law, F);
    double scale = 0;
    for (const auto& row : A)
      for (const double entry : row) scale = std::max(scale, std::abs(entry));
    for (int k = 0; k < 9; ++k) {
      const double h = 1e-5;
      Matrix plus = F, minus = F;
      plus(k / 3, k % 3) += h;
      minus(k / 3, k % 3) -= h;
      const auto high = isochoric_stress(law, to_tensor(plus));
      const auto low = isochoric_stress(law, to_tensor(minus));
      for (std::size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(A[i][to_index(k)], (high[i] - low[i]) / (2 * h), 2e-8 * scale);
    }
  }
}

TYPED_TEST(EveryLaw, IsObjective) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix F = random_gradient(random), R = random_rotation(random);
    const double W = energy(law, to_tensor(F));
    EXPECT_NEAR(energy(law, to_tensor(R * F)), W, 1e-10 * W);
    const Matrix P = to_matrix(stress(law, to_tensor(F)));
    EXPECT_LT((to_matrix(stress(law, to_tensor(R * F))) - R * P).norm(), 1e-10 * P.norm());
  }
}

Fibres<double> rotated(const Matrix& R, const Fibres<double>& a) {
  Fibres<double> b;
  for (std::size_t f = 0; f < 2; ++f)
    Eigen::Map<Eigen::Vector3d>(b[f].data()) = R * Eigen::Map<const Eigen::Vector3d>(a[f].data());
  return b;
}

TYPED_TEST(EveryLaw, HasTheSymmetryOfItsMaterial) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix F = random_gradient(random), R = random_rotation(random);
    const double W = energy(law, to_tensor(F));
    if constexpr (!Anisotropic<TypeParam>) {
      EXPECT_NEAR(energy(law, to_tensor(F * R)), W, 1e-10 * W);
    } else {
      // Turned with its fibres it is the same body, turned without them another; a body of one
      // family may be spun about that and mirrored across it.
      EXPECT_NEAR(energy(law, to_tensor(F * R.transpose()), rotated(R, kFibres)), W, 1e-10 * W);
      EXPECT_GT(std::abs(energy(law, to_tensor(F * R.transpose())) - W), 1e-6 * W);
      const Eigen::Vector3d a(kFibres[0].data());
      const Fibres<double> one{kFibres[0], kFibres[0]};
      const double single = energy(law, to_tensor(F), one);
      const Matrix spin = Eigen::AngleAxisd(0.3 + trial, a).toRotationMatrix();
      const Matrix turn_over = Eigen::AngleAxisd(M_PI, a.unitOrthogonal()).toRotationMatrix();
      EXPECT_NEAR(energy(law, to_tensor(F * spin), one), single, 1e-10 * single);
      EXPECT_NEAR(energy(law, to_tensor(F * turn_over), one), single, 1e-10 * single);
    }
  }
}

/// Where a law has a simpler one as its limit, it must be that one, in stress and tangent.
TEST(Limits, BecomeNeoHookean) {
  const double mu = 3e3, kappa = 5e4;
  const auto reference = NeoHookean::from_moduli(mu, kappa);
  std::mt19937 random(6);
  const auto expect_same = [&](const auto& law, double tolerance) {
    for (int trial = 0; trial < 10; ++trial) {
      const Matrix F = random_gradient(random);
      const auto P = stress(law, to_tensor(F)), P0 = stress(reference, to_tensor(F));
      const auto A = isochoric_tangent(law, F), A0 = isochoric_tangent(reference, F);
      for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(P[i], P0[i], tolerance * mu);
        for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(A[i][k], A0[i][k], 10 * tolerance * mu);
      }
    }
  };
  expect_same(MooneyRivlin({.C10 = mu / 2, .C01 = 0}, kappa), 1e-11);
  expect_same(MooneyRivlin5({.C10 = mu / 2, .C01 = 0, .C20 = 0, .C11 = 0, .C02 = 0}, kappa), 1e-11);
  expect_same(Yeoh({.C10 = mu / 2, .C20 = 0, .C30 = 0}, kappa), 1e-11);
  expect_same(Ogden({{mu, 2}}, kappa), 1e-11);
  expect_same(DemirayFung({.mu = mu, .b = 1e-9}, kappa), 1e-7);
  expect_same(Gent({.mu = mu, .J_m = 1e9}, kappa), 1e-7);
  expect_same(ArrudaBoyce({.mu = mu, .lambda_m = 1e5}, kappa), 1e-7);
  expect_same(HolzapfelGasserOgden({.c = mu, .k1 = 0, .k2 = 1, .dispersion = 0}, {}, kappa), 1e-11);
}

/// The table makes the law that its name says, and eight at once are what each is alone.
TYPED_TEST(EveryLaw, OfTheTableEqualsTheScalarOneInEveryLane) {
  const auto law = Sample<TypeParam>::make();
  std::optional<Law> made;
  for (const LawConstants& sample : test::sample_laws(kPoisson))
    if (sample.law == Sample<TypeParam>::kName) made = make_law(sample, "tissue");
  ASSERT_TRUE(made);
  std::mt19937 random(7);
  Tensor2<Lanes> F;
  Fibres<Lanes> a;
  std::array<Matrix, kLanes> single;
  for (std::size_t f = 0; f < 2; ++f)
    for (std::size_t i = 0; i < 3; ++i) a[f][i] = Lanes::Constant(kFibres[f][i]);
  for (int lane = 0; lane < kLanes; ++lane) {
    single[to_index(lane)] = random_gradient(random);
    for (int i = 0; i < 9; ++i) F[to_index(i)][lane] = single[to_index(lane)](i / 3, i % 3);
  }
  const auto cof = cofactor(F);
  const Lanes J = determinant(F, cof);
  const Lanes W = made->psi(F, J, a), U = made->volumetric_energy(J), p = made->pressure(J);
  const auto P = made->piola(F, cof, J, a);
  Tensor4<Lanes> A;
  for (auto& row : A) row.fill(Lanes::Zero());
  made->add_tangent(F, cof, J, a, A);
  for (int lane = 0; lane < kLanes; ++lane) {
    const Matrix& one = single[to_index(lane)];
    const double size = energy(law, to_tensor(one));
    EXPECT_NEAR(W[lane] + U[lane], size, 1e-10 * size);
    const auto expected = isochoric_stress(law, to_tensor(one));
    const auto tangent = isochoric_tangent(law, one);
    const double scale = to_matrix(expected).norm();
    EXPECT_NEAR(p[lane], law.pressure(one.determinant()), 1e-10 * std::abs(p[lane]));
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(P[i][lane], expected[i], 1e-10 * scale);
      for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(A[i][k][lane], tangent[i][k], 1e-8 * scale);
    }
  }
}

}  // namespace
}  // namespace palpate::fem
