// SPDX-License-Identifier: AGPL-3.0-or-later
// Ogden's law in the principal frame: what the tests of every law do not see.
#include "fem/laws/ogden.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/fem/laws/law_samples.hpp"

namespace palpate::fem {
namespace {

using Strains = std::array<double, 3>;

const std::vector<OgdenTerm<>> kRubber{{2e3, 1.3}, {0.5e3, 9}, {0.7e3, -2}};  // Pa, pure

/// sum 2 mu/alpha^2 (l_1^a + l_2^a + l_3^a - 3) of logarithmic strains of any volume.
double energy_of(const Strains& e) {
  const double mean = (e[0] + e[1] + e[2]) / 3;
  double sum = 0;
  for (const OgdenTerm<>& term : kRubber)
    for (const double each : e)
      sum += 2 * term.mu / std::pow(term.alpha, 2) * (std::exp(term.alpha * (each - mean)) - 1);
  return sum;
}

/// Strains in every order and of every sign, with and without equal ones; isochoric.
std::vector<Strains> strains() {
  std::vector<Strains> all;
  for (const double a : {-0.6, -0.1, 0.0, 0.3, 0.7})
    for (const double b : {-0.5, -0.1, 0.0, 0.2, 0.3}) all.push_back({a, b, -a - b});
  return all;
}

TEST(OgdenStresses, AreTheSlopesOfTheEnergyInThePrincipalStrains) {
  constexpr double h = 1e-5;
  for (const Strains& e : strains()) {
    const auto s = principal_stresses(kRubber, e);
    const double scale = 3e3 + std::abs(s.tau[0]) + std::abs(s.tau[1]) + std::abs(s.tau[2]);
    for (std::size_t j = 0; j < 3; ++j) {
      Strains more = e, less = e;
      more[j] += h, less[j] -= h;
      EXPECT_NEAR(s.tau[j], (energy_of(more) - energy_of(less)) / (2 * h), 1e-7 * scale);
      // The strains of a change of one stretch alone, less its change of volume.
      const auto isochoric = [](Strains x) {
        const double mean = (x[0] + x[1] + x[2]) / 3;
        for (double& each : x) each -= mean;
        return x;
      };
      const auto high = principal_stresses(kRubber, isochoric(more)).tau;
      const auto low = principal_stresses(kRubber, isochoric(less)).tau;
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(s.slope[i][j], (high[i] - low[i]) / (2 * h), 1e-6 * scale);
    }
  }
}

TEST(OgdenStresses, HaveNoMeanAndDoNotChangeWithTheVolume) {
  for (const Strains& e : strains()) {
    const auto s = principal_stresses(kRubber, e);
    const double scale = std::abs(s.tau[0]) + std::abs(s.tau[1]) + std::abs(s.tau[2]) + 1;
    EXPECT_NEAR(s.tau[0] + s.tau[1] + s.tau[2], 0, 1e-12 * scale);
    for (std::size_t i = 0; i < 3; ++i) {
      const double stiffness = std::abs(s.slope[i][0]) + std::abs(s.slope[i][1]);
      EXPECT_NEAR(s.slope[i][0] + s.slope[i][1] + s.slope[i][2], 0, 1e-12 * stiffness);
      for (std::size_t j = 0; j < 3; ++j)
        EXPECT_NEAR(s.slope[i][j], s.slope[j][i], 1e-12 * stiffness);
    }
  }
}

/// The Baker-Ericksen inequalities: the greater principal stress goes with the greater stretch
/// where every mu_p is positive.
TEST(OgdenStresses, AreInTheOrderOfTheStretches) {
  for (const Strains& e : strains()) {
    const auto tau = principal_stresses(kRubber, e).tau;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        if (e[i] > e[j]) {
          EXPECT_GT(tau[i], tau[j]);
        }
      }
  }
}

TEST(OgdenEnergy, DoesNotSeeAUniformChangeOfVolume) {
  const Ogden law(kRubber, 0);
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix F = random_gradient(random);
    const double psi = law.psi(to_tensor(F), F.determinant());
    for (const double c : {0.6, 1.7}) {
      const Matrix swollen = c * F;
      EXPECT_NEAR(law.psi(to_tensor(swollen), swollen.determinant()), psi, 1e-11 * psi);
    }
  }
}

/// The sum of mu_p is the shear modulus, whatever the exponents: nominal stress 3 mu strain of a
/// small extension.
TEST(OgdenEnergy, HasTheSumOfItsTermsAsShearModulus) {
  const double mu = 2e3 + 0.5e3 + 0.7e3, e = 1e-4;
  const auto tau = principal_stresses(kRubber, Strains{e, -e / 2, -e / 2}).tau;
  EXPECT_NEAR((tau[0] - tau[1]) / e, 3 * mu, 1e-3 * mu);
}

TEST(OgdenEnergy, IsPolyconvexForTheExponentsOfHartmannAndNeff) {
  const auto polyconvex = [](double mu, double alpha) {
    return Ogden({{mu, alpha}}, 1).polyconvex();
  };
  EXPECT_TRUE(polyconvex(1, 1.5));
  EXPECT_FALSE(polyconvex(1, 1.49));
  EXPECT_TRUE(polyconvex(1, -3));
  EXPECT_FALSE(polyconvex(1, -2.99));
  EXPECT_FALSE(polyconvex(-1, 2));
  EXPECT_FALSE(Ogden({{1, 2}, {1, 1}}, 1).polyconvex());  // every term must be
}

}  // namespace
}  // namespace palpate::fem
