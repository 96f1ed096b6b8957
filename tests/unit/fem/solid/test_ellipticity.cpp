// SPDX-License-Identifier: AGPL-3.0-or-later
// Strong ellipticity of the laws: states in closed form at which it is lost, a search over all
// directions, and laws that never lose it.
#include "fem/solid/ellipticity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <random>

#include "fem/laws/law.hpp"
#include "fem/laws/law_table.hpp"
#include "fem/solid/element.hpp"
#include "fem/solid/solid_model.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/sample_laws.hpp"

namespace palpate::fem {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

struct PointOfLaw {
  Tensor2<Lanes> F;
  Tensor4<Lanes> A;
};

/// dP/dF of a law at F, in every lane; the pressure is left out, as it adds nothing.
PointOfLaw point_of(const Law& law, const Matrix& F) {
  PointOfLaw point;
  for (int i = 0; i < 9; ++i) point.F[to_index(i)] = Lanes::Constant(F.data()[i]);
  const Tensor2<Lanes> cof = cofactor(point.F);
  const Lanes J = determinant(point.F, cof);
  Fibres<Lanes> fibres;
  for (std::size_t family = 0; family < 2; ++family)
    for (std::size_t i = 0; i < 3; ++i)
      fibres[family][i] = Lanes::Constant(law.fibres_at({0, 0, 0})[family][i]);
  for (auto& row : point.A) row.fill(Lanes::Zero());
  law.add_tangent(point.F, cof, J, fibres, point.A);
  add_dilatation_tangent(cof, law.pressure_slope(J), point.A);
  return point;
}

Tensor4<double> first_lane(const Tensor4<Lanes>& A) {
  Tensor4<double> one;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t k = 0; k < 9; ++k) one[i][k] = A[i][k][0];
  return one;
}

double weakest_of(const Law& law, const Matrix& F) {
  return min_acoustic_eigenvalue(first_lane(point_of(law, F).A));
}

/// Stretches from 0.4 to 2.5 between two random rotations, det F from 0.6 to 1.6.
Matrix random_gradient(std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-1, 1);
  const auto rotation = [&]() -> Matrix {
    Eigen::Quaterniond q(entry(random), entry(random), entry(random), entry(random));
    return q.normalized().toRotationMatrix();
  };
  Eigen::Vector3d stretch;
  for (int i = 0; i < 3; ++i) stretch[i] = std::pow(2.5, entry(random));
  stretch *= std::cbrt((1.1 + 0.5 * entry(random)) / stretch.prod());
  return rotation() * stretch.asDiagonal() * rotation();
}

/// Those of every law, and two that soften.
std::vector<LawConstants> sound_and_softening_laws() {
  std::vector<LawConstants> laws = test::sample_laws(0.45);
  laws.push_back({"yeoh", {{"C10", 1e3}, {"C20", -300}, {"C30", 0}, {"poisson", 0.45}}});
  laws.push_back({"mooney-rivlin", {{"C10", -1e3}, {"C01", 2e3}, {"poisson", 0.45}}});
  return laws;
}

/// At F = a 1 the eigenvalues of Q are S + mu a^2, twice, and S + (lambda + 2 mu) a^2, with the
/// stress S = 3 K (a^2 - 1)/2: ellipticity ends where a^2 = 3 K/(3 K + 2 mu).
TEST(Ellipticity, OfSaintVenantKirchhoffEndsInCompressionAsInClosedForm) {
  const LawConstants constants("saint-venant-kirchhoff", {{"young", 10e3}, {"poisson", 0.3}});
  const Law law = make_law(constants, "t");
  const double mu = rest_moduli(constants).mu(), K = rest_moduli(constants).kappa();
  const double end = std::sqrt(3 * K / (3 * K + 2 * mu));
  for (const double a : {0.9 * end, 0.999 * end, 1.001 * end, 1.0, 1.2}) {
    const double expected = 1.5 * K * (a * a - 1) + mu * a * a;
    const double found = weakest_of(law, a * Matrix::Identity());
    EXPECT_NEAR(found, expected, 1e-9 * mu) << "a = " << a;
    EXPECT_EQ(found > 0, a > end) << "a = " << a;
  }
}

/// A solid W(I1) that cannot change its volume is elliptic in plane strain while the stress of
/// simple shear, 2 k W'(k^2), rises with the amount of shear k [Knowles 1977; Abeyaratne 1980]:
/// here up to k^2 = -C10/(6 C20).
TEST(Ellipticity, OfASofteningSolidEndsWhereTheStressOfSimpleShearPeaks) {
  const double C10 = 1e3, C20 = -150;
  const Law law =
      make_law({"yeoh", {{"C10", C10}, {"C20", C20}, {"C30", 0}, {"poisson", 0.49999}}}, "t");
  EXPECT_FALSE(law.polyconvex());
  const double peak = std::sqrt(-C10 / (6 * C20));
  for (const double part : {0.2, 0.6, 0.98, 0.995, 1.005, 1.02, 1.2}) {
    Matrix F = Matrix::Identity();
    F(0, 1) = part * peak;
    EXPECT_EQ(weakest_of(law, F) > 0, part < 1) << "k = " << part << " of the peak";
  }
}

/// Against a grid of directions, in states on both sides of the limit.
TEST(Ellipticity, MinimumIsBelowThatOnAnyGrid) {
  std::mt19937 random(5);
  int lost = 0, elliptic = 0;
  for (const LawConstants& constants : sound_and_softening_laws())
    for (int trial = 0; trial < 3; ++trial) {
      const Law law = make_law(constants, "t");
      const Tensor4<double> A = first_lane(point_of(law, random_gradient(random)).A);
      double grid = 1e300;
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
      constexpr int kRings = 60;
      for (int ring = 0; ring < kRings; ++ring)
        for (int step = 0; step < 2 * kRings; ++step) {
          const double z = (ring + 0.5) / kRings, angle = std::numbers::pi * step / kRings;
          const Eigen::Vector3d n(std::sqrt(1 - z * z) * std::cos(angle),
                                  std::sqrt(1 - z * z) * std::sin(angle), z);
          Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
          for (int entry = 0; entry < 81; ++entry) {
            const int iJ = entry / 9, kL = entry % 9;
            Q(iJ / 3, kL / 3) += A[to_index(iJ)][to_index(kL)] * n[iJ % 3] * n[kL % 3];
          }
          grid = std::min(grid, eigen.compute(Q).eigenvalues()[0]);
        }
      const double found = min_acoustic_eigenvalue(A);
      double size = 0;
      for (std::size_t i = 0; i < 9; ++i) size = std::max(size, std::abs(A[i][i]));
      EXPECT_LE(found, grid + 1e-9 * size) << constants.law;
      EXPECT_GT(found, grid - 0.01 * size) << constants.law;
      ++(found > 0 ? elliptic : lost);
    }
  EXPECT_GE(lost, 3);
  EXPECT_GE(elliptic, 20);
}

/// The check of eight points at once never calls a state elliptic that is not, and decides most
/// states that are.
TEST(Ellipticity, SufficientConditionIsRight) {
  std::mt19937 random(6);
  for (const LawConstants& constants : sound_and_softening_laws())
    for (int trial = 0; trial < 15; ++trial) {
      const PointOfLaw point = point_of(make_law(constants, "t"), random_gradient(random));
      EXPECT_EQ(min_acoustic_eigenvalue(point.F, point.A)[3] > 0,
                min_acoustic_eigenvalue(first_lane(point.A)) > 0)
          << constants.law;
    }
}

TEST(Ellipticity, PolyconvexLawsNeverLoseIt) {
  std::mt19937 random(7);
  int polyconvex = 0;
  for (const double poisson : {0.0, 0.3, 0.499})
    for (const LawConstants& constants : test::sample_laws(poisson)) {
      const Law law = make_law(constants, "t");
      if (!law.polyconvex()) continue;
      ++polyconvex;
      for (int trial = 0; trial < 60; ++trial)
        EXPECT_GT(weakest_of(law, random_gradient(random)), 0) << constants.law;
    }
  EXPECT_EQ(polyconvex, 3 * 8);
}

/// The element in which ellipticity is lost first; none where it is not lost.
TEST(Ellipticity, OfABodyIsLostWhereItIsCompressedMost) {
  const Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, 0.04, 4));
  const LawConstants softening("saint-venant-kirchhoff", {{"young", 10e3}, {"poisson", 0.3}});
  const LawConstants neo_hookean(10e3, 0.3);
  for (const Dilatation dilatation : {Dilatation::Mean, Dilatation::Nodal, Dilatation::Pointwise}) {
    const SolidModel soft(body, {make_law(softening, "t")}, dilatation);
    const SolidModel sound(body, {make_law(neo_hookean, "t")}, dilatation);
    Displacement u = Displacement::Zero(3, soft.mesh().nodes());
    EXPECT_FALSE(soft.ellipticity_loss(u));
    // Compressed along z, more and more towards the top.
    for (int node = 0; node < soft.mesh().nodes(); ++node) {
      const double z = soft.mesh().X(2, node);
      u(2, node) = -0.5 * z * z / 0.04;
    }
    EXPECT_FALSE(sound.ellipticity_loss(u));
    const auto loss = soft.ellipticity_loss(u);
    ASSERT_TRUE(loss);
    EXPECT_LT(loss->stiffness, 0);
    EXPECT_GT(loss->X[2], 0.03);
  }
}

}  // namespace
}  // namespace palpate::fem
