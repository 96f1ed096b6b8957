// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/specimen/clamped.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "format/error.hpp"

namespace palpate::fem {
namespace {

/// A clot of 40 x 10 x 3 mm and the forces on its clamps of a finite element model that its authors
/// published with the record (github.com/elejeune11/fitting-one-term-ogden-model,
/// FEA/RigidForce.txt; MIT), times four for its quarter: mN at travels of both clamps together.
struct Published {
  double travel_mm, force_mN;
};
constexpr Published kPublished[] = {
    {0.5, 4 * 12.7304911639}, {1, 4 * 24.5954940027}, {2, 4 * 47.2719966434}};

ClampedSpecimen clot() {
  ClampedSpecimen specimen;
  specimen.length = 0.010;
  specimen.width = 0.040;
  specimen.thickness = 0.003;
  // FEBio's c1 is 2 mu; its k of 1 MPa gives this Poisson's ratio.
  const double mu = 0.5 * 4497.597719603, kappa = 1e6;
  specimen.law = {"ogden-1",
                  {{"mu_1", mu},
                   {"alpha_1", 4.175454824210},
                   {"poisson", (3 * kappa - 2 * mu) / (2 * (3 * kappa + mu))}}};
  return specimen;
}

TEST(ClampedSpecimen, HasTheForcesOfAPublishedModel) {
  const ClampedSpecimen specimen = clot();
  std::vector<double> stretches;
  for (const Published& p : kPublished) stretches.push_back(1 + p.travel_mm / 10);
  const std::vector<double> stress = clamped_stress(specimen, stretches);
  for (std::size_t i = 0; i < stress.size(); ++i)
    EXPECT_NEAR(stress[i] * specimen.area() * 1e3, kPublished[i].force_mN,
                0.004 * kPublished[i].force_mN);
}

/// A long thin bar is hardly held by its clamps: it is in uniaxial tension.
TEST(ClampedSpecimen, IsUniaxialWhereItIsLong) {
  ClampedSpecimen bar;
  bar.length = 0.04;
  bar.diameter = 0.002;
  bar.law = LawConstants(3000, 0.49);
  const double stress = clamped_stress(bar, {1.1}).front();
  const double expected = 3000 / 3.0 * (1.1 - 1 / (1.1 * 1.1));
  EXPECT_NEAR(stress, expected, 0.03 * expected);
}

/// A flat disc between glued plates: the apparent modulus of an incompressible one is E (1 + 2
/// S^2), S its shape factor, radius over twice the height, and bulk compression is in series with
/// it [Gent & Lindley 1959].
TEST(ClampedSpecimen, IsStiffWhereItIsFlat) {
  constexpr double kYoung = 3000, kPoisson = 0.49;
  ClampedSpecimen disc;
  disc.length = 0.004;
  disc.diameter = 0.016;
  disc.law = LawConstants(kYoung, kPoisson);
  const double shape = 0.25 * disc.diameter / disc.length;
  const double bulk = kYoung / (3 * (1 - 2 * kPoisson));
  const double apparent = 1 / (1 / (kYoung * (1 + 2 * shape * shape)) + 1 / bulk);
  const double stress = clamped_stress(disc, {0.99}).front();
  EXPECT_NEAR(stress, -0.01 * apparent, 0.1 * 0.01 * apparent);
}

TEST(ClampedSpecimen, RefusesWhatItCannotBe) {
  ClampedSpecimen specimen = clot();
  EXPECT_THROW(clamped_stress(specimen, {-0.1}), Error);
  specimen.width = 0;
  EXPECT_THROW(clamped_stress(specimen, {1.1}), Error);
}

}  // namespace
}  // namespace palpate::fem
