// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/account.hpp"
#include "format/numbers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace palpate::app {
namespace {

/// Exact stresses of an incompressible neo-Hookean solid, P = mu (l - l^-2).
calibrate::HomogeneousTest uniaxial(double mu) {
  calibrate::HomogeneousTest test{"tension", calibrate::Mode::Uniaxial, {}, {}};
  for (double l = 1.05; l < 1.5; l += 0.05) {
    test.deformation.push_back(l);
    test.nominal.push_back(mu * (l - 1 / (l * l)));
  }
  return test;
}

TEST(CalibrationAccount, HasTheConstantsAndTheFitOfEachTest) {
  constexpr double kMu = 4e3;
  calibrate::HomogeneousSettings settings;
  settings.law = "neo-hookean";
  const std::vector<calibrate::HomogeneousTest> tests{uniaxial(kMu)};
  const auto fit = calibrate::fit_homogeneous(tests, settings);
  const auto account = homogeneous_account(fit, settings, tests);
  EXPECT_EQ(account.at("law"), "neo-hookean");
  EXPECT_NEAR(account.at("shear_modulus_Pa").get<double>(), kMu, 1e-3 * kMu);
  ASSERT_EQ(account.at("constants").size(), 1u);
  EXPECT_EQ(account.at("constants").at(0).at("unit"), "Pa");
  const auto& test = account.at("tests").at(0);
  EXPECT_EQ(test.at("test"), "tension");
  EXPECT_EQ(test.at("measured_nominal_Pa").size(), tests[0].nominal.size());
  for (std::size_t i = 0; i < tests[0].nominal.size(); ++i)
    EXPECT_NEAR(test.at("fitted_nominal_Pa").at(i).get<double>(), tests[0].nominal[i], 1e-3 * kMu);
  const std::string material = account.at("case_material");
  EXPECT_THAT(material, testing::StartsWith("law = \"neo-hookean\"\nyoung = "));
  EXPECT_EQ(std::count(material.begin(), material.end(), '\n'), 3) << material;  // and poisson
}

/// What is not known is null, which every reader of JSON takes; NaN none.
TEST(CalibrationAccount, WritesWhatIsUnknownAsNull) {
  calibrate::Calibration calibration;
  calibrate::Estimate estimate;
  estimate.name = "mu";
  estimate.standard_error = kUnknown;
  estimate.high = std::numeric_limits<double>::infinity();
  estimate.low = 1;
  calibration.estimates = {estimate};
  calibration.correlation = {{kUnknown}};
  const auto account = calibration_account(calibration, 0.95);
  const auto& constant = account.at("constants").at(0);
  EXPECT_TRUE(constant.at("standard_error").is_null());
  EXPECT_TRUE(constant.at("high").is_null());
  EXPECT_TRUE(constant.at("profile_low").is_null());
  EXPECT_EQ(constant.at("low"), 1);
  EXPECT_TRUE(account.at("correlation").at(0).at(0).is_null());
  EXPECT_EQ(account.dump().find("nan"), std::string::npos);
}

TEST(CalibrationAccount, IsSaidLineByLine) {
  calibrate::Calibration calibration;
  calibrate::Estimate free, bound;
  free.name = "mu", free.unit = "Pa", free.value = 4000, free.low = 3900, free.high = 4100;
  bound.name = "b", bound.unit = "1", bound.value = 20, bound.at_bound = true;
  calibration.estimates = {free, bound};
  calibration.warnings = {"the data do not say b"};
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  say_calibration(calibration, 0.95);
  EXPECT_EQ(testing::internal::GetCapturedStdout(),
            "  mu = 4000 Pa, 95 % interval 3900 to 4100\n  b = 20, at its bound\n");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "warning: the data do not say b\n");
}

/// A gel of 0.4 Pa, of which a micro-indenter sees micronewtons, in units that fit.
TEST(CalibrationAccount, SaysSmallStressesInTheirUnit) {
  calibrate::HomogeneousSettings settings;
  settings.law = "neo-hookean";
  auto test = uniaxial(0.4);
  for (std::size_t i = 0; i < test.nominal.size(); ++i)
    test.nominal[i] += i % 2 == 0 ? 2e-3 : -2e-3;
  const auto fit = calibrate::fit_homogeneous({test}, settings);
  testing::internal::CaptureStdout();
  say_homogeneous(fit);
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_THAT(text, testing::HasSubstr("shear modulus at rest: 0.4"));
  EXPECT_THAT(text, testing::ContainsRegex("tension: rms [12]\\.[0-9]+ mPa"));
}

/// Lengths are shifts of contact points: a metre is no unit for them.
TEST(CalibrationAccount, SaysLengthsInUnitsThatFit) {
  calibrate::Calibration calibration;
  calibrate::Estimate shift;
  shift.name = "contact shift of site 3";
  shift.unit = "m";
  shift.value = 1.21e-4;
  shift.low = -3e-6;
  shift.high = 2.45e-4;
  calibration.estimates = {shift};
  testing::internal::CaptureStdout();
  say_calibration(calibration, 0.95);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::HasSubstr("site 3 = 0.121 mm, 95 % interval -3.00 um to 0.245 mm"));
}

}  // namespace
}  // namespace palpate::app
