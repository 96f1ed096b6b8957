// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/relaxation_account.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/fitting/measurement/relaxation/sphere_record.hpp"

namespace palpate::app {
namespace {

using calibrate::RampAndHold;

TEST(RelaxationAccount, HasTheKeysOfACase) {
  EXPECT_EQ(
      relaxation_keys({{0.3, 0.05}, {0.25, 2}}),
      "relaxation = [{ fraction = 0.3, time = \"0.05 s\" }, { fraction = 0.25, time = \"2 s\" "
      "}]\nmoduli = \"instantaneous\"\n");
}

/// Hertz: 10 kPa, incompressible, 5 mm, 1 mm deep: F = 16/9 E sqrt(R) d^1.5.
TEST(RelaxationAccount, GivesTheModulusOfAHalfSpace) {
  const double force = 16.0 / 9 * 1e4 * std::sqrt(5e-3) * std::pow(1e-3, 1.5);
  EXPECT_NEAR(half_space_modulus(force, 5e-3, 1e-3), 1e4, 1e-6);
}

TEST(RelaxationAccount, HasBothConstantsTheBandAndEverySample) {
  const RampAndHold sphere{0.2, 1e-3, 0.4, {{0.5, 2}}};
  const std::vector<calibrate::RelaxationRecord> records{record_on(sphere, 20, 500, {1e-3, 0, 1})};
  const calibrate::RelaxationSettings settings;
  const auto fit = calibrate::fit_relaxation(records, settings);
  const auto account = relaxation_account(fit, settings, records, 5e-3);
  const auto& record = account.at("records").at(0);
  EXPECT_NEAR(record.at("instantaneous_force_N").at("value").get<double>(), 0.2, 4e-3);
  EXPECT_NEAR(record.at("long_term_force_N").at("value").get<double>(), 0.1, 4e-3);
  EXPECT_NEAR(record.at("long_term_half_space_young_Pa").at("value").get<double>() /
                  record.at("instantaneous_half_space_young_Pa").at("value").get<double>(),
              0.5, 0.02);
  EXPECT_EQ(record.at("fitted_N").size(), 500u);
  EXPECT_EQ(account.at("relaxation").size(), 1u);
  for (const auto& point : account.at("relaxation_function")) {
    EXPECT_LE(point.at("low").get<double>(), point.at("value").get<double>());
    const double t = point.at("time_s").get<double>();
    EXPECT_NEAR(point.at("value").get<double>(), 0.5 + 0.5 * std::exp(-t / 2), 0.01);
  }
  EXPECT_THAT(account.at("case_material").get<std::string>(), testing::HasSubstr("fraction = 0.5"));
}

}  // namespace
}  // namespace palpate::app
