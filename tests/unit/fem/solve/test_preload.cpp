// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/preload.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/factor/cholesky.hpp"
#include "fem/laws/law_table.hpp"
#include "format/error.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;

Body column(double width, double height) {
  return test::make_block(test::even(0, width, 1), test::even(0, width, 1),
                          test::even(0, height, 8));
}

Displacement displaced(const Body& body, const LawConstants& law, const Gravity& gravity) {
  const SolidModel model(body, {make_law(law, "t")}, Dilatation::Pointwise, gravity);
  return equilibrium_under_weight(model, nested_dissection(model.pattern()), body.name);
}

/// Mean displacement of the top along z.
double top_displacement(const Body& body, const Displacement& u) {
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  double sum = 0;
  int count = 0;
  for (int node = 0; node < mesh.nodes(); ++node) {
    if (mesh.X(2, node) < mesh.X.row(2).maxCoeff() - 1e-9) continue;
    sum += u(2, node);
    ++count;
  }
  return sum / count;
}

/// With nu = 0 and small strains u = -rho g/E (H Z - Z^2/2), which quadratic elements represent
/// exactly.
TEST(Preload, ShortensAStandingColumnAsInClosedForm) {
  constexpr double kHeight = 0.08, kYoung = 10e6, kDensity = 1000, kGravity = 9.81;
  const Body body = column(0.06, kHeight);
  const Displacement u = displaced(body, {kYoung, 0.0}, {{0, 0, -kGravity}, kDensity});
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  const double scale = kDensity * kGravity / kYoung * kHeight * kHeight / 2;
  for (int node = 0; node < mesh.nodes(); ++node) {
    const double Z = mesh.X(2, node);
    const double expected = -kDensity * kGravity / kYoung * (kHeight * Z - Z * Z / 2);
    EXPECT_NEAR(u(2, node), expected, 2e-4 * scale);
    EXPECT_NEAR(u(0, node), 0, 2e-4 * scale);
  }
}

/// Saint Venant-Kirchhoff with nu = 0 has no lateral stress: E/2 lambda (lambda^2 - 1) = +-rho g (H
/// - Z) at every height, at any strain.
TEST(Preload, OfColumnsAtLargeStrainIsTheClosedForm) {
  constexpr double kHeight = 0.08, kYoung = 10e3, kDensity = 1000;
  const Body body = column(0.06, kHeight);
  const LawConstants law("saint-venant-kirchhoff", {{"young", kYoung}, {"poisson", 0}});
  for (const double g : {20.0, -10.0}) {
    const auto stretch = [&](double Z) {
      double low = 1 / std::sqrt(3.0), high = 3;
      for (int i = 0; i < 100; ++i) {
        const double l = 0.5 * (low + high);
        (0.5 * kYoung * l * (l * l - 1) < kDensity * g * (kHeight - Z) ? low : high) = l;
      }
      return low;
    };
    double expected = 0;
    constexpr int kSteps = 2000;  // by the midpoint rule
    for (int i = 0; i < kSteps; ++i)
      expected += (stretch((i + 0.5) * kHeight / kSteps) - 1) * kHeight / kSteps;
    const double found = top_displacement(body, displaced(body, law, {{0, 0, g}, kDensity}));
    EXPECT_NEAR(found, expected, 1e-3 * std::abs(expected)) << g;
    EXPECT_GT(std::abs(expected), 0.02 * kHeight);
  }
}

/// A slender column buckles under its own weight beyond H^3 = 7.837 E I/(rho g A) [Greenhill 1881].
TEST(Preload, RefusesAColumnThatBuckles) {
  constexpr double kWidth = 0.01, kYoung = 1e6, kDensity = 1000, kGravity = 9.81;
  const double greatest = std::cbrt(7.837 * kYoung * kWidth * kWidth / 12 / (kDensity * kGravity));
  const Gravity gravity{{0, 0, -kGravity}, kDensity};
  EXPECT_NO_THROW(displaced(column(kWidth, 0.9 * greatest), {kYoung, 0.0}, gravity));
  try {
    displaced(column(kWidth, 1.1 * greatest), {kYoung, 0.0}, gravity);
    FAIL() << "a column above the buckling height has an equilibrium";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_THAT(error.what(), HasSubstr("no equilibrium beyond"));
  }
}

TEST(Preload, IsZeroWithoutGravity) {
  EXPECT_TRUE(displaced(column(0.06, 0.08), {1e4, 0.3}, {}).isZero(0));
}

/// A linear field on a facet is reproduced between its nodes.
TEST(Preload, InterpolatesDisplacementsOnTheBoundary) {
  const QuadraticMesh mesh = make_quadratic_mesh(column(0.06, 0.08));
  Eigen::Matrix3d G;
  G << 0.1, 0.02, -0.03, 0.04, -0.2, 0.06, 0.07, 0.08, 0.3;
  const Displacement u = G * mesh.X;
  const Eigen::Vector3d on(0.013, 0.021, 0.08), above(0.013, 0.021, 0.09);
  EXPECT_LT((displacement_at(mesh, u, on) - G * on).norm(), 1e-12);
  EXPECT_LT((displacement_at(mesh, u, above) - G * on).norm(), 1e-12);
}

}  // namespace
}  // namespace palpate::fem
