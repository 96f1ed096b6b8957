// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/relaxation/branch_stresses.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::fem {
namespace {

const RelaxationSeries kFirst{{0.3, 0.1}, {0.2, 2}}, kSecond{{0.5, 0.1}};

/// Two elements of two regions under the same stress.
class Branches {
 public:
  /// The isochoric stress of an element after a step of length `h` to the stress `S` at once.
  double after(double h, double S, std::size_t element) {
    const HistoryStress step = branches_.step(h);
    const double stress = step.factor[element] * S + step.stress[element][3][5];
    StressField field(2);
    for (auto& one : field)
      for (Stress& point : one) point.fill(S);
    branches_.advance(h, field);
    return stress;
  }

 private:
  BranchStresses branches_{over_one_list({kFirst, kSecond}, "t"), {0, 1}};
};

TEST(BranchStresses, RelaxExactlyAfterAStepWhateverTheTimeSteps) {
  for (const std::size_t element : {0U, 1U}) {
    const RelaxationSeries& series = element == 0 ? kFirst : kSecond;
    Branches branches;
    EXPECT_DOUBLE_EQ(branches.after(0, 100, element), 100);
    double t = 0;
    for (const double h : {0.01, 0.3, 1e-4, 5.0, 100.0}) {
      t += h;
      EXPECT_NEAR(branches.after(h, 100, element), 100 * relaxed_fraction(series, t), 1e-12);
    }
  }
}

/// Integral of g over a ramp of unit rate.
double ramp(const RelaxationSeries& series, double t) {
  double stress = long_term_fraction(series) * t;
  for (const auto& [g, tau] : series) stress += g * tau * (1 - std::exp(-t / tau));
  return stress;
}

TEST(BranchStresses, FollowARampWithSecondOrder) {
  double before = 0;
  for (const int steps : {20, 40, 80}) {
    Branches branches;
    const double h = 0.4 / steps;
    double stress = 0;
    for (int i = 1; i <= steps; ++i) stress = branches.after(h, i * h, 0);
    const double error = std::abs(stress - ramp(kFirst, 0.4));
    if (before > 0) {
      EXPECT_NEAR(before / error, 4, 0.05);
    }
    before = error;
  }
  EXPECT_LT(before, 1e-5 * 0.4);
}

}  // namespace
}  // namespace palpate::fem
