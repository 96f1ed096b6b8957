// SPDX-License-Identifier: AGPL-3.0-or-later
// Data of known constants are calibrated, the constants are pasted into a case as they are printed,
// and the law that the solver makes of that case has the stress of the data: for every law.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/case/case.hpp"
#include "app/case/material.hpp"
#include "fem/laws/energy_of_law.hpp"
#include "fem/laws/law.hpp"
#include "fitting/measurement/calibrate/homogeneous_fit.hpp"
#include "format/error.hpp"
#include "tests/support/sample_laws.hpp"

namespace palpate::app {
namespace {

using calibrate::Mode;
using testing::HasSubstr;

constexpr double kPoisson = 0.47;

/// Nominal stress that the solver's law has in a homogeneous deformation of unit volume ratio:
/// the work of P along the family of deformations, in which a pressure has no part.
double solver_stress(const fem::Law& law, Mode mode, double s) {
  const std::array<double, 3> e = calibrate::logarithmic_strains(mode, s);
  fem::Tensor2<fem::Lanes> F;
  F.fill(fem::Lanes::Zero());
  for (std::size_t i = 0; i < 3; ++i) F[4 * i] = fem::Lanes::Constant(std::exp(e[i]));
  const auto P = law.piola(F, fem::cofactor(F), fem::Lanes::Constant(1.0), {});
  double work = 0;
  constexpr double h = 1e-6;
  const std::array<double, 3> before = calibrate::logarithmic_strains(mode, s - h),
                              after = calibrate::logarithmic_strains(mode, s + h);
  for (std::size_t i = 0; i < 3; ++i)
    work += P[4 * i][0] * (std::exp(after[i]) - std::exp(before[i])) / (2 * h);
  return mode == Mode::Equibiaxial ? work / 2 : work;
}

/// Four tests up to moderate strains, by the solver's own law.
std::vector<calibrate::HomogeneousTest> tests_of(const fem::LawConstants& constants) {
  const fem::Law law = fem::make_law(constants, "tissue");
  std::vector<calibrate::HomogeneousTest> tests;
  for (const Mode mode : {Mode::Uniaxial, Mode::Equibiaxial, Mode::PureShear, Mode::SimpleShear}) {
    calibrate::HomogeneousTest test{"synthetic", mode, {}, {}, {}, 1};
    for (int i = -5; i <= 20; ++i) {
      if (i == 0) continue;
      const double s = calibrate::rest_of(mode) + 0.03 * i;
      test.deformation.push_back(s);
      test.nominal.push_back(solver_stress(law, mode, s));
    }
    tests.push_back(test);
  }
  return tests;
}

fem::LawConstants pasted(const std::string& material) {
  const std::string text =
      "[surface]\nfile = \"a.off\"\nunit = \"mm\"\n[[support]]\nshape = \"sphere\"\n"
      "centre = [\"0 mm\", \"0 mm\", \"0 mm\"]\nradius = \"1 mm\"\n[[material]]\n" +
      material;
  return parse_case(text, "pasted.toml").materials.at(0).law;
}

class CalibratedCase : public testing::TestWithParam<fem::LawConstants> {};

TEST_P(CalibratedCase, HasTheStressOfTheData) {
  const fem::LawConstants& truth = GetParam();
  calibrate::HomogeneousSettings settings;
  settings.law = truth.law;
  settings.poisson = kPoisson;
  if (!fem::has_isotropic_energy(truth.law)) {
    try {
      calibrate::IncompressibleLaw law(truth.law);
      FAIL() << truth.law << " was accepted";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("law '" + truth.law + "': homogeneous tests cannot"));
    }
    return;
  }
  const auto tests = tests_of(truth);
  const calibrate::HomogeneousFit fit = calibrate::fit_homogeneous(tests, settings);
  const fem::LawConstants found = pasted(material_keys(fit.law));
  EXPECT_EQ(found.law, truth.law);
  ASSERT_EQ(found.values.size(), truth.values.size());
  for (std::size_t i = 0; i < found.values.size(); ++i) {
    EXPECT_EQ(found.values[i].first, truth.values[i].first);
    EXPECT_EQ(found.values[i].second, fit.law.values[i].second) << "not printed in full";
  }
  EXPECT_EQ(found.at("poisson"), kPoisson);
  const fem::Law law = fem::make_law(found, "pasted");
  for (const auto& test : tests)
    for (std::size_t i = 0; i < test.nominal.size(); ++i)
      EXPECT_NEAR(solver_stress(law, test.mode, test.deformation[i]), test.nominal[i],
                  2e-4 * std::abs(test.nominal[i]) + 1)
          << calibrate::mode_name(test.mode) << " " << test.deformation[i];
}

/// Where the data determine the constants, they are those that made the data, by name.
TEST_P(CalibratedCase, HasTheConstantsOfTheData) {
  const fem::LawConstants& truth = GetParam();
  if (!fem::has_isotropic_energy(truth.law)) return;
  if (truth.law == "ogden-2" || truth.law == "ogden-3") return;  // several sets fit such data alike
  calibrate::HomogeneousSettings settings;
  settings.law = truth.law;
  settings.poisson = kPoisson;
  const calibrate::HomogeneousFit fit = calibrate::fit_homogeneous(tests_of(truth), settings);
  for (const auto& [name, value] : truth.values)
    EXPECT_NEAR(fit.law.at(name), value, 1e-3 * std::abs(value)) << name;
}

INSTANTIATE_TEST_SUITE_P(Table, CalibratedCase, testing::ValuesIn(test::sample_laws(kPoisson)),
                         [](const auto& instance) {
                           std::string name = instance.param.law;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace palpate::app
