// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "fitting/measurement/calibrate/homogeneous_fit.hpp"
#include "fitting/measurement/calibrate/stability.hpp"

namespace palpate::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(Stability, WarnsOfALawThatLosesStability) {
  EXPECT_GT(law_tangent("yeoh", {0.5, -0.02, 0.003}, Mode::Uniaxial, 1.5), 0);
  EXPECT_LT(law_tangent("yeoh", {0.5, -0.2, 0}, Mode::Uniaxial, 2), 0);
  HomogeneousTest test{"falling", Mode::Uniaxial, {}, {}, {}, 1};
  for (int i = 1; i <= 30; ++i) {
    const double s = 1 + 0.05 * i;
    test.deformation.push_back(s);
    test.nominal.push_back(law_stress("yeoh", {5e3, -6e2, 20}, test.mode, s));
  }
  HomogeneousSettings settings;
  settings.law = "yeoh";
  const HomogeneousFit fit = fit_homogeneous({test}, settings);
  EXPECT_TRUE(std::isfinite(fit.stability[0].unstable_at));
  EXPECT_THAT(fit.calibration.warnings, Contains(HasSubstr("unstable in the range")));
}

/// Least eigenvalue of the Hessian of W by (e1, e2) by differences.
double least_eigenvalue(const std::function<double(double, double)>& W, double x, double y) {
  const double h = 1e-4;
  const double a = (W(x + h, y) - 2 * W(x, y) + W(x - h, y)) / (h * h);
  const double d = (W(x, y + h) - 2 * W(x, y) + W(x, y - h)) / (h * h);
  const double b =
      (W(x + h, y + h) - W(x + h, y - h) - W(x - h, y + h) + W(x - h, y - h)) / (4 * h * h);
  return 0.5 * (a + d) - std::hypot(0.5 * (a - d), b);
}

/// Mooney-Rivlin with a negative C01 meets a compression test and fails in tension, at strains that
/// the test has in its sides: the fit must say where, although no test went there.
TEST(Stability, WarnsOfInstabilityOutsideTheModesOfTheTests) {
  constexpr double C10 = 1000, C01 = -100;
  HomogeneousTest test{"compression", Mode::Uniaxial, {}, {}, {}, 1};
  for (int i = 1; i <= 30; ++i) {
    const double s = 1 - 0.7 / 30 * i;
    test.deformation.push_back(s);
    test.nominal.push_back(2 * (s - 1 / (s * s)) * (C10 + C01 / s));
  }
  HomogeneousSettings settings;
  settings.law = "mooney-rivlin";
  const HomogeneousFit fit = fit_homogeneous({test}, settings);
  EXPECT_NEAR(fit.calibration.estimates[1].value, C01, 1e-3);
  EXPECT_TRUE(std::isnan(fit.stability[0].unstable_at));
  EXPECT_THAT(fit.calibration.warnings, Contains(HasSubstr("outside the modes of the tests")));
  const auto W = [&](double x, double y) {
    const double a = std::exp(x), b = std::exp(y), c = 1 / (a * b);
    return C10 * (a * a + b * b + c * c) + C01 * (1 / (a * a) + 1 / (b * b) + 1 / (c * c));
  };
  const auto& l = fit.all_states.unstable_at;
  EXPECT_NEAR(l[0] * l[1] * l[2], 1, 1e-12);
  EXPECT_LT(least_eigenvalue(W, std::log(l[0]), std::log(l[1])), 0);
  // No state of less strain is: the scan goes outwards by hundredths of the largest strain.
  const double reached = std::max(std::log(l[0]), -std::log(l[2]));
  const double before = reached - 0.011 * fit.all_states.largest_strain;
  for (int i = 0; i < 360; ++i) {
    const double x = std::cos(i * std::numbers::pi / 180), y = std::sin(i * std::numbers::pi / 180);
    const double largest = std::max({std::abs(x), std::abs(y), std::abs(x + y)});
    EXPECT_GT(least_eigenvalue(W, before * x / largest, before * y / largest), 0);
  }
  // With both constants positive the law is stable everywhere.
  settings.constants = {{"C10", true, 500, 0, 1e6}, {"C01", true, 10, 0, 1e6}};
  EXPECT_TRUE(std::isnan(fit_homogeneous({test}, settings).all_states.unstable_at[0]));
}

}  // namespace
}  // namespace palpate::calibrate
