// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "fitting/measurement/relaxation/hereditary.hpp"
#include "tests/unit/fitting/measurement/relaxation/lee_radok.hpp"

namespace palpate::calibrate {
namespace {

const RelaxationSeries kSeries{{0.3, 0.05}, {0.25, 2}};

PronySeries<double> prony(const RelaxationSeries& series) {
  PronySeries<double> p;
  for (const RelaxationBranch& b : series) {
    p.fraction.push_back(b.fraction);
    p.time.push_back(b.time_s);
  }
  return p;
}

TEST(Hereditary, IsTheClosedFormOfASphereThatIsPressedAndHeld) {
  const RampAndHold sphere{2, 1e-3, 0.5, kSeries};
  const std::vector<double> t = even_times(5, 20001);
  std::vector<double> elastic;
  for (const double s : t) elastic.push_back(2 * std::pow(sphere.travel(s) / 1e-3, 1.5));
  const std::vector<double> f = hereditary_force(t, elastic, prony(kSeries));
  for (std::size_t i = 0; i < t.size(); i += 200) EXPECT_NEAR(f[i], sphere.force(t[i]), 2e-6);
}

/// An elastic force that is linear between few times is integrated exactly:
/// integral of g(t - s) ds over the ramp [Lee & Radok 1960, for a punch].
TEST(Hereditary, IsExactForALinearRampInOneStep) {
  const std::vector<double> t{0, 0.5, 3}, elastic{0, 1, 1};
  const std::vector<double> f = hereditary_force(t, elastic, prony(kSeries));
  double at_end = 0.45, later = 0.45;
  for (const RelaxationBranch& b : kSeries) {
    const double risen = b.fraction * b.time_s / 0.5 * (1 - std::exp(-0.5 / b.time_s));
    at_end += risen;
    later += risen * std::exp(-2.5 / b.time_s);
  }
  EXPECT_NEAR(f[1], at_end, 1e-14);
  EXPECT_NEAR(f[2], later, 1e-14);
}

/// A force that is applied at once and held: the creep compliance of the standard linear solid,
/// J(t) = 1/g_inf - (1/g_inf - 1) exp(-g_inf t/tau) [Findley, Lai & Onaran 1976, table 5.1].
TEST(Hereditary, SolvesTheVolterraEquationOfCreep) {
  const RelaxationSeries solid{{0.6, 1.5}};
  const std::vector<double> t = even_times(10, 4001);
  const std::vector<double> e = elastic_force(t, std::vector<double>(t.size(), 2.0), prony(solid));
  for (std::size_t i = 0; i < t.size(); i += 100)
    EXPECT_NEAR(e[i], 2 * (1 / 0.4 - (1 / 0.4 - 1) * std::exp(-0.4 * t[i] / 1.5)), 1e-6);
}

TEST(Hereditary, IsUndoneByItsInverse) {
  const std::vector<double> t{0, 0.001, 0.05, 0.3, 0.31, 2, 30};
  const std::vector<double> elastic{0.1, 0.4, 2, 1, 1.5, 0.2, 0.7};
  const auto back = elastic_force(t, hereditary_force(t, elastic, prony(kSeries)), prony(kSeries));
  for (std::size_t i = 0; i < t.size(); ++i) EXPECT_NEAR(back[i], elastic[i], 1e-13);
}

}  // namespace
}  // namespace palpate::calibrate
