// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/preload.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/factor/cholesky.hpp"
#include "fem/laws/law_table.hpp"
#include "format/error.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/heavy_rod.hpp"

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

/// The number that precedes " % of its weight" in a message.
double percent_in(const std::string& message) {
  const std::size_t end = message.find(" % of its weight");
  return std::stod(message.substr(message.rfind(' ', end - 1) + 1));
}

/// A slender column buckles under its own weight beyond H^3 = 7.837 E I/(rho g A) [Greenhill 1881],
/// a given column under (H_c/H)^3 of its weight. A leaning one, too, bends over at about that
/// weight, to one of two sides that it cannot know.
TEST(Preload, NamesTheWeightUnderWhichAColumnBuckles) {
  constexpr double kWidth = 0.01, kYoung = 1e6, kDensity = 1000, kGravity = 9.81;
  const double greatest = std::cbrt(7.837 * kYoung * kWidth * kWidth / 12 / (kDensity * kGravity));
  const Gravity gravity{{0, 0, -kGravity}, kDensity};
  for (const double lean : {0.0, 1e-3}) {
    const auto leaning = [&](double height) {
      Body body = test::make_block(test::even(0, kWidth, 1), test::even(0, kWidth, 1),
                                   test::even(0, height, 24));
      test::deform(body, [&](const Vec3& X) { return X + Vec3{lean * X[2], 0, 0}; });
      return body;
    };
    for (const double height : {0.9, 0.97})
      EXPECT_NO_THROW(displaced(leaning(height * greatest), {kYoung, 0.0}, gravity)) << height;
    for (const double height : {1.05, 1.5, 3.0}) try {
        displaced(leaning(height * greatest), {kYoung, 0.0}, gravity);
        ADD_FAILURE() << "a column of " << height
                      << " times the greatest height has an equilibrium";
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Geometry);
        EXPECT_THAT(error.problem(), HasSubstr("buckles"));
        const double critical = 100 * std::pow(height, -3);
        EXPECT_NEAR(percent_in(error.problem()), critical, 0.03 * critical) << error.what();
      }
  }
}

/// Saint Venant-Kirchhoff with nu = 0 carries at most E/(3 sqrt(3)) in compression. The straight
/// line to the vanishing stiffness of a limit point overestimates the weight.
TEST(Preload, NamesTheWeightUnderWhichABodyCollapses) {
  constexpr double kHeight = 0.05, kYoung = 1e3, kDensity = 1e5, kGravity = 9.81;
  const Body body = column(kHeight, kHeight);
  const LawConstants law("saint-venant-kirchhoff", {{"young", kYoung}, {"poisson", 0}});
  const double critical = 100 * kYoung / (3 * std::sqrt(3)) / (kDensity * kGravity * kHeight);
  try {
    displaced(body, law, {{0, 0, -kGravity}, kDensity});
    FAIL() << "the column carries more than its material";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_NEAR(percent_in(error.problem()), critical, 0.25 * critical) << error.what();
  }
}

/// The shape of a limp rod whose clamp points upwards is that of the elastica. (That of a level
/// clamp is among the verification problems.)
TEST(Preload, BendsARodLikeTheElastica) {
  constexpr double kRadius = 0.004, kLength = 0.2, kYoung = 5e5, kDensity = 1000, kGravity = 9.81;
  const double weight = kDensity * kGravity * M_PI * std::pow(kRadius, 2);
  const double bending = kYoung * M_PI / 4 * std::pow(kRadius, 4);
  const double clamped = 0.8 * M_PI;
  const Body body = test::make_rod(kRadius, kLength, 24);
  const Eigen::Vector3d down(0, -std::sin(clamped), std::cos(clamped));
  const Displacement u =
      displaced(body, {kYoung, 0.3}, {{0, kGravity * down[1], kGravity * down[2]}, kDensity});
  const Eigen::Vector3d tip = Eigen::Vector3d(0, 0, kLength) + u.col(24 * 19);
  const test::RodTip expected = test::heavy_elastica(weight, bending, kLength, clamped);
  const Eigen::Vector3d across(0, std::cos(clamped), std::sin(clamped));
  EXPECT_NEAR(tip.dot(down), expected.along, 0.01 * kLength);
  EXPECT_NEAR(tip.dot(across), expected.across, 0.01 * kLength);
  EXPECT_GT(expected.along, 0.5 * kLength);
}

/// A heavy soft column: the whole weight at once does not converge.
TEST(Preload, TellsItsStepsAndHasTheSameBitsOnAnyThreads) {
  const Body body =
      test::make_block(test::even(0, 0.02, 3), test::even(0, 0.02, 3), test::even(0, 0.06, 9));
  const SolidModel model(body, {make_law({2e3, 0.45}, "t")}, Dilatation::Mean,
                         Gravity{{0, 0, 9.81}, 1000});
  const auto permutation = nested_dissection(model.pattern());
  std::vector<PreloadProgress> told;
  const Displacement alone = equilibrium_under_weight(model, permutation, body.name);
  const Displacement u = equilibrium_under_weight(
      model, permutation, body.name,
      {{.threads = 3}, [&](const PreloadProgress& p) { told.push_back(p); }});
  EXPECT_EQ(u, alone);
  Eigen::VectorXd residual;
  model.forces(u, residual);
  EXPECT_LT(residual.norm(), 2e-9 * model.weight().norm());
  ASSERT_FALSE(told.empty());
  for (std::size_t i = 0; i < told.size(); ++i) EXPECT_EQ(told[i].steps, static_cast<int>(i) + 1);
}

TEST(Preload, RefusesTooLittleMemory) {
  const SolidModel model(column(0.02, 0.04), {make_law({8e3, 0.45}, "t")}, Dilatation::Mean,
                         Gravity{{0, 0, -9.81}, 1000});
  EXPECT_THROW(equilibrium_under_weight(model, nested_dissection(model.pattern()), "column",
                                        {{.memory = 1}, {}}),
               Error);
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
