// SPDX-License-Identifier: AGPL-3.0-or-later
// The compiled response against its definition: the slope is the only thing stored, so force and
// energy must be its first and second integrals, found here by quadrature.
#include "runtime/response_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "format/error.hpp"

namespace palpate::runtime {
namespace {

/// The stored slope, straight from its definition in the file format.
double stored_slope(const ResponseCurve& curve, double d) {
  if (d >= static_cast<double>(curve.knot.back())) return static_cast<double>(curve.slope.back());
  std::size_t k = 0;
  while (d >= static_cast<double>(curve.knot[k + 1])) ++k;
  const double start = static_cast<double>(curve.knot[k]);
  const double h = static_cast<double>(curve.knot[k + 1]) - start;
  const double s0 = static_cast<double>(curve.slope[k]);
  const double s1 = static_cast<double>(curve.slope[k + 1]);
  return s0 + (s1 - s0) * (d - start) / h;
}

double adaptive(const std::function<double(double)>& f, double a, double b, double fa, double fm,
                double fb, double whole, double tolerance, int depth) {
  const double m = (a + b) / 2;
  const double fl = f((a + m) / 2);
  const double fr = f((m + b) / 2);
  const double left = (m - a) / 6 * (fa + 4 * fl + fm);
  const double right = (b - m) / 6 * (fm + 4 * fr + fb);
  if (depth == 0 || std::abs(left + right - whole) < 15 * tolerance) return left + right;
  return adaptive(f, a, m, fa, fl, fm, left, tolerance / 2, depth - 1) +
         adaptive(f, m, b, fm, fr, fb, right, tolerance / 2, depth - 1);
}

/// Adaptive Simpson quadrature.
double integral(const std::function<double(double)>& f, double a, double b, double tolerance) {
  const double fa = f(a);
  const double fm = f((a + b) / 2);
  const double fb = f(b);
  return adaptive(f, a, b, fa, fm, fb, (b - a) / 6 * (fa + 4 * fm + fb), tolerance, 40);
}

ResponseCurve random_curve(std::mt19937& random) {
  std::uniform_real_distribution<float> step(0.0002F, 0.002F);
  std::uniform_real_distribution<float> slope(0.0F, 900.0F);
  ResponseCurve curve;
  float d = 0;
  const int knots = 2 + static_cast<int>(random() % 11);
  for (int k = 0; k < knots; ++k) {
    curve.knot.push_back(d);
    curve.slope.push_back(k == 0 ? 0.0F : slope(random));
    d += step(random);
  }
  return curve;
}

TEST(ResponseCurve, ForceIsTheIntegralOfTheStoredSlope) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const ResponseCurve stored = random_curve(random);
    const CompiledCurve curve(stored);
    for (const double part : {0.01, 0.3, 0.77, 1.0, 1.4}) {
      const double d = part * static_cast<double>(stored.knot.back());
      const double expected =
          integral([&](double y) { return stored_slope(stored, y); }, 0, d, 1e-10);
      EXPECT_NEAR(curve.force(d), expected, 1e-8);
      EXPECT_NEAR(curve.slope(d), stored_slope(stored, d), 1e-9);
    }
  }
}

TEST(ResponseCurve, EnergyIsTheIntegralOfTheForce) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const CompiledCurve curve(random_curve(random));
    for (const double part : {0.05, 0.5, 1.0, 1.6}) {
      const double d = part * curve.last_knot();
      const double expected = integral([&](double y) { return curve.force(y); }, 0, d, 1e-14);
      EXPECT_NEAR(curve.energy(d), expected, 1e-12);
    }
  }
}

TEST(ResponseCurve, ForceAndSlopeAreContinuousAtEveryKnot) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const ResponseCurve stored = random_curve(random);
    const CompiledCurve curve(stored);
    for (std::size_t k = 1; k < stored.knot.size(); ++k) {
      const double d = static_cast<double>(stored.knot[k]);
      const double below = std::nextafter(d, 0.0);
      EXPECT_NEAR(curve.force(below), curve.force(d), 1e-12);
      EXPECT_NEAR(curve.slope(below), curve.slope(d), 1e-8);
      EXPECT_NEAR(curve.energy(below), curve.energy(d), 1e-15);
    }
  }
}

TEST(ResponseCurve, ReproducesTheQuadraticThenLinearWall) {
  // f = 100 k d^2 up to 5 mm, then k (d - 2.5 mm).
  const double k = 170;
  ResponseCurve stored;
  stored.knot = {0.0F, 0.005F, 0.010F};
  stored.slope = {0.0F, 170.0F, 170.0F};
  const CompiledCurve curve(stored);
  EXPECT_NEAR(curve.force(0.003), 100 * k * 9e-6, 1e-8);
  EXPECT_NEAR(curve.force(0.008), k * 0.0055, 1e-7);
  EXPECT_NEAR(curve.force(0.020), k * 0.0175, 1e-7);
  EXPECT_EQ(curve.max_slope(), 170.0);
}

TEST(ResponseCurve, IsZeroOutOfContactAndNeverSteeperThanItsLargestSlope) {
  std::mt19937 random(4);
  const CompiledCurve curve(random_curve(random));
  for (const double d : {0.0, -1e-9, -1.0, -std::numeric_limits<double>::infinity()}) {
    const CurveValue value = curve.evaluate(d);
    EXPECT_EQ(value.force, 0.0);
    EXPECT_EQ(value.slope, 0.0);
    EXPECT_EQ(value.energy, 0.0);
  }
  double steepest = 0;
  for (int i = 1; i <= 4000; ++i) {
    const double d = 2.0 * curve.last_knot() * i / 4000;
    const double h = 1e-7;
    steepest = std::max(steepest, (curve.force(d + h) - curve.force(d - h)) / (2 * h));
  }
  EXPECT_LE(steepest, curve.max_slope() * (1 + 1e-8));
  EXPECT_GE(steepest, curve.max_slope() * 0.99);
}

TEST(ResponseCurve, WeightIsThatOfATouchWithoutContact) {
  const CompiledCurve w({{0.0F, 0.005F}, {0.0F, 60.0F}}, 0.5);
  for (const double z : {-0.001, 0.0}) {
    EXPECT_EQ(w.weight(z), 0.5) << z;
    EXPECT_EQ(w.force(z), 0) << z;
  }
  // w' rises by 60/m over 5 mm: w = 0.5 + 6000 z^2.
  EXPECT_NEAR(w.weight(0.003), 0.5 + 6000 * 9e-6, 1e-7);
}

TEST(ResponseCurve, RejectsWhatIsNoPassiveResponse) {
  const auto make = [](std::vector<float> knot, std::vector<float> slope) {
    ResponseCurve curve;
    curve.knot = std::move(knot);
    curve.slope = std::move(slope);
    return CompiledCurve(curve);
  };
  EXPECT_THROW(make({0.0F}, {0.0F}), Error);
  EXPECT_THROW(make({0.0F, 1.0F}, {0.0F}), Error);
  EXPECT_THROW(make({0.1F, 1.0F}, {0.0F, 1.0F}), Error);
  EXPECT_THROW(make({0.0F, 1.0F, 1.0F}, {0.0F, 1.0F, 1.0F}), Error);
  EXPECT_THROW(make({0.0F, 1.0F}, {0.0F, -1.0F}), Error);
  EXPECT_THROW(make({0.0F, 1.0F}, {-1.0F, 1.0F}), Error);
  EXPECT_THROW(make({0.0F, 1.0F}, {0.0F, std::numeric_limits<float>::quiet_NaN()}), Error);
  EXPECT_THROW(make({0.0F, std::numeric_limits<float>::infinity()}, {0.0F, 1.0F}), Error);
}

}  // namespace
}  // namespace palpate::runtime
