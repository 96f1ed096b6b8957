// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/levenberg_marquardt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "format/numbers.hpp"
#include "tests/unit/fitting/measurement/calibrate/line.hpp"

namespace palpate::calibrate {
namespace {

constexpr int kDepths = 6;

/// Presses by a small sphere: force mu d^1.5 (1 + b d/3)^0.3, whose stiffening grows slower and
/// slower with b, and a shift of the contact point with its stated uncertainty. mu, b and the shift
/// can stand for each other.
struct SmallSphere {
  double touch = 0;                ///< of the record, depth is 1 at its end
  double own = 0.01;               ///< uncertainty of the forces, over the largest
  double contact = 0.1;            ///< uncertainty of the shift
  std::set<double> stiffenings{};  ///< that the forces were asked for

  static double depth(int i) { return (i + 1.0) / kDepths; }
  /// What was recorded: a force of another kind, whose modulus grows with the depth.
  double measured(int i) const {
    const double d = depth(i) - touch, miss = i % 2 == 0 ? 0.5 : -0.5;
    return 0.55 * std::pow(d, 1.5) * (1 + 0.8 * d) + miss * own;
  }
  static double slope(int i) { return 1.5 * std::sqrt(depth(i)); }

  LeastSquares problem(double low, double high) {
    LeastSquares p;
    p.constants = {{"mu", "Pa", 0.7, 1e-3, 1e3, false, false, true},
                   {"b", "1", 1, low, high},
                   {"shift", "m", 0, -kInfinity, kInfinity, true, false, true}};
    p.residuals = kDepths + 1;
    p.known_scatter = true;
    p.offset_tolerance = 0.01;
    p.model = [this](const double* c, double* r, double* J) {
      stiffenings.insert(c[1]);
      for (int i = 0; i < kDepths; ++i) {
        const double d = depth(i), stiffened = 1 + c[1] * d / 3;
        const double unit = std::pow(d, 1.5) * std::pow(stiffened, 0.3) / own;
        r[i] = c[0] * unit + (slope(i) * c[2] - measured(i)) / own;
        if (J == nullptr) continue;
        *J++ = unit;
        *J++ = c[0] * unit * 0.1 * d / stiffened;
        *J++ = slope(i) / own;
      }
      r[kDepths] = c[2] / contact;
      if (J != nullptr) J[0] = J[1] = 0, J[2] = 1 / contact;
      return true;
    };
    return p;
  }

  /// The least cost over b, at places that are close enough; mu and the shift from their normal
  /// equations.
  double least_cost(double low, double high) const {
    constexpr int kPlaces = 20000;
    double least = kInfinity;
    for (int k = 0; k <= kPlaces; ++k) {
      const double b = low * std::pow(high / low, static_cast<double>(k) / kPlaces);
      double uu = 0, us = 0, ss = 1 / (contact * contact), uf = 0, sf = 0, ff = 0;
      for (int i = 0; i < kDepths; ++i) {
        const double d = depth(i), f = measured(i) / own, s = slope(i) / own;
        const double u = std::pow(d, 1.5) * std::pow(1 + b * d / 3, 0.3) / own;
        uu += u * u, us += u * s, ss += s * s, uf += u * f, sf += s * f, ff += f * f;
      }
      const double det = uu * ss - us * us;
      const double mu = (uf * ss - sf * us) / det, shift = (sf * uu - uf * us) / det;
      least = std::min(least, 0.5 * (ff - mu * uf - shift * sf));
    }
    return least;
  }
};

/// From b = 1, whose forces have hardly begun to stiffen, to an end within the bounds or at one.
TEST(LevenbergMarquardt, FollowsTheValleyOfAStiffeningLaw) {
  constexpr double kLow = 0.01, kHigh = 100;
  int at_bound = 0;
  for (const double touch : {-0.1, -0.05, -0.02, 0.0, 0.02, 0.05, 0.1}) {
    for (const double contact : {0.02, 0.05, 0.15}) {
      for (const bool linear_first : {false, true}) {
        SmallSphere sphere{.touch = touch, .contact = contact};
        LeastSquares problem = sphere.problem(kLow, kHigh);
        problem.linear_first = linear_first;
        const auto found = descend(problem);
        ASSERT_TRUE(found);
        EXPECT_TRUE(found->converged);
        // A hundredth of a standard error, and what nonlinearity adds to it.
        EXPECT_LT(found->cost, sphere.least_cost(kLow, kHigh) + 2e-4);
        if (linear_first) {
          EXPECT_LE(sphere.stiffenings.size(), 8U) << touch << " " << contact;
        }
        at_bound += found->at[1] == kHigh || found->at[1] == kLow ? 1 : 0;
      }
    }
  }
  EXPECT_GT(at_bound, 4);
}

/// Where noise hides the rest it stops earlier than where it is asked for every digit.
TEST(LevenbergMarquardt, StopsWhereNoiseHidesTheRest) {
  SmallSphere rough{.touch = -0.1, .contact = 0.02}, fine = rough;
  LeastSquares digits = fine.problem(0.01, 100);
  digits.offset_tolerance = 0;
  const auto exact = levenberg_marquardt(digits);
  const auto close = levenberg_marquardt(rough.problem(0.01, 100));
  ASSERT_TRUE(exact && close);
  EXPECT_TRUE(exact->converged && close->converged);
  EXPECT_LT(rough.stiffenings.size(), fine.stiffenings.size());
  EXPECT_LT(close->cost - exact->cost, 1e-4);
  EXPECT_GE(close->cost, exact->cost);
}

/// Rosenbrock's valley has its end at (1, 1); with x at most 0.5 it is at (0.5, 0.25).
TEST(LevenbergMarquardt, EndsInABentValleyAndAtItsBound) {
  LeastSquares problem;
  problem.constants = {{"x", "1", -1.2, -2, 2}, {"y", "1", 1, -2, 2}};
  problem.residuals = 2;
  problem.model = [](const double* c, double* r, double* J) {
    r[0] = 10 * (c[1] - c[0] * c[0]);
    r[1] = 1 - c[0];
    if (J != nullptr) J[0] = -20 * c[0], J[1] = 10, J[2] = -1, J[3] = 0;
    return true;
  };
  auto found = levenberg_marquardt(problem);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->converged);
  EXPECT_NEAR(found->at[0], 1, 1e-9);
  EXPECT_NEAR(found->at[1], 1, 1e-9);
  problem.constants[0].high = 0.5;
  found = levenberg_marquardt(problem);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->converged);
  EXPECT_EQ(found->at[0], 0.5);
  EXPECT_NEAR(found->at[1], 0.25, 1e-9);
  EXPECT_NEAR(found->cost, 0.125, 1e-12);
}

/// Steps to where the model has no value are shortened; none at the start is no end at all.
TEST(LevenbergMarquardt, StaysWhereTheModelHasAValue) {
  LeastSquares problem;
  problem.constants = {{"x", "1", 1, -kInfinity, kInfinity}};
  problem.residuals = 1;
  problem.model = [](const double* c, double* r, double* J) {
    r[0] = std::log(c[0]) + 3;
    if (J != nullptr) J[0] = 1 / c[0];
    return c[0] > 0;
  };
  const auto found = levenberg_marquardt(problem);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->converged);
  EXPECT_NEAR(found->at[0], std::exp(-3), 1e-9);
  problem.constants[0].start = -1;
  EXPECT_FALSE(levenberg_marquardt(problem));
}

}  // namespace
}  // namespace palpate::calibrate
