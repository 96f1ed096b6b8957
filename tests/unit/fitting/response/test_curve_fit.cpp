// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "fitting/response/curve_fit.hpp"
#include "format/error.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

using Samples = std::vector<ForceSample>;

constexpr double kDepth = 0.006;

template <class Force>
Samples sampled(int count, double depth, Force&& force) {
  Samples samples;
  for (int i = 1; i <= count; ++i) {
    const double d = depth * i / count;
    samples.push_back({d, force(d)});
  }
  return samples;
}

/// Hertz: rigid sphere of radius 5 mm on a half space with E = 10 kPa, nu = 0.49 [Hertz 1881].
double hertz(double d) {
  return 4.0 / 3 * (1e4 / (1 - 0.49 * 0.49)) * std::sqrt(0.005) * std::pow(d, 1.5);
}

double largest_secant(const Samples& samples) {
  ForceSample low{0, 0};
  double largest = 0;
  for (const ForceSample& high : samples) {
    largest = std::max(largest, (high.force - low.force) / (high.displacement - low.displacement));
    low = high;
  }
  return largest;
}

void expect_passive(const ResponseCurve& curve) {
  ASSERT_GE(curve.knot.size(), 2u);
  ASSERT_EQ(curve.knot.size(), curve.slope.size());
  EXPECT_EQ(curve.knot[0], 0.0f);
  for (std::size_t k = 1; k < curve.knot.size(); ++k) EXPECT_GT(curve.knot[k], curve.knot[k - 1]);
  for (const float slope : curve.slope) EXPECT_GE(slope, 0.0f);
}

TEST(CurveFit, FollowsHertzWithFewKnots) {
  const Samples samples = sampled(12, kDepth, hertz);
  const CurveFit fit = fit_curve(samples, {0.01, 1e-4, 12, true}, "test");
  expect_passive(fit.curve);
  EXPECT_LE(fit.worst_ratio, 1);
  EXPECT_LE(fit.curve.knot.size(), 5u);
  EXPECT_EQ(fit.curve.slope[0], 0.0f);
  const runtime::CompiledCurve rendered(fit.curve);
  // Between the samples the fit stays within twice the tolerance.
  double worst = 0;
  for (double d = 0.0005; d < kDepth; d += 1.7e-5) {
    worst = std::max(worst, std::abs(rendered.force(d) / hertz(d) - 1));
  }
  EXPECT_LT(worst, 0.02);
  // The energy of d^1.5 is 2/5 d f.
  EXPECT_NEAR(rendered.energy(kDepth), 0.4 * kDepth * hertz(kDepth),
              0.01 * 0.4 * kDepth * hertz(kDepth));
  // The largest slope determines the certificate: 3/2 f/d at the end.
  EXPECT_NEAR(rendered.max_slope(), 1.5 * hertz(kDepth) / kDepth, 0.05 * rendered.max_slope());
}

/// Samples of d^exponent with the means of the force between them.
Samples with_means(int count, double exponent) {
  const auto energy = [&](double d) { return std::pow(d, exponent + 1) / (exponent + 1); };
  Samples samples = sampled(count, kDepth, [&](double d) { return std::pow(d, exponent); });
  double since = 0;
  for (ForceSample& sample : samples) {
    sample.since = since;
    sample.mean = (energy(sample.displacement) - energy(since)) / (sample.displacement - since);
    since = sample.displacement;
  }
  return samples;
}

double worst_between(const Samples& samples, double exponent, double tolerance) {
  const CurveFit fit = fit_curve(
      samples, {tolerance, tolerance * std::pow(0.1 * kDepth, exponent), 12, exponent > 1}, "test");
  expect_passive(fit.curve);
  const runtime::CompiledCurve rendered(fit.curve);
  double worst = 0;
  for (double d = 0.1 * kDepth; d <= kDepth; d += 0.003 * kDepth)
    worst = std::max(worst, std::abs(rendered.force(d) / std::pow(d, exponent) - 1));
  return worst;
}

/// Contacts of a sphere, of a cone, and of a cylinder on soft layers; a lateral force that yields.
TEST(CurveFit, MeansOfTheForceReplaceEverySecondSample) {
  for (const double exponent : {0.8, 1.5, 2.2, 2.6}) {
    constexpr double kTolerance = 0.004;
    Samples many = with_means(10, exponent), few = with_means(5, exponent);
    for (ForceSample& sample : many) sample.mean = std::numeric_limits<double>::quiet_NaN();
    const double with = worst_between(few, exponent, kTolerance);
    EXPECT_LE(with, std::max(worst_between(many, exponent, kTolerance), 1.5 * kTolerance))
        << exponent;
    for (ForceSample& sample : few) sample.mean = std::numeric_limits<double>::quiet_NaN();
    EXPECT_LT(with, worst_between(few, exponent, kTolerance)) << exponent;
  }
}

/// A mean since another sample than the one before says nothing of the force between the two.
TEST(CurveFit, LeavesOutMeansOverOtherIntervals) {
  Samples samples = with_means(5, 1.5);
  const CurveFitSettings settings{0.01, 1e-8, 12, true};
  for (ForceSample& sample : samples) sample.since *= 0.5;
  samples.front().mean = std::numeric_limits<double>::quiet_NaN();
  const CurveFit with = fit_curve(samples, settings, "test");
  for (ForceSample& sample : samples) sample.mean = std::numeric_limits<double>::quiet_NaN();
  const CurveFit without = fit_curve(samples, settings, "test");
  EXPECT_EQ(with.curve.knot, without.curve.knot);
  EXPECT_EQ(with.curve.slope, without.curve.slope);
}

TEST(CurveFit, FollowsTheStiffeningOfTissue) {
  // An exponential law: initial slope 20 N/m, six times that at the end.
  const auto law = [](double d) { return 20 * 0.0033 * std::expm1(d / 0.0033); };
  const Samples samples = sampled(12, kDepth, law);
  const CurveFit fit = fit_curve(samples, {0.01, 1e-4, 12, false}, "test");
  expect_passive(fit.curve);
  EXPECT_LE(fit.worst_ratio, 1);
  EXPECT_LE(fit.curve.knot.size(), 5u);
  const double end_slope = 20 * std::exp(kDepth / 0.0033);
  EXPECT_NEAR(runtime::CompiledCurve(fit.curve).max_slope(), end_slope, 0.08 * end_slope);
}

TEST(CurveFit, RecoversAnExactCurveOfTheModel) {
  const ResponseCurve truth{{0.0f, 0.003f, 0.006f}, {0.0f, 120.0f, 90.0f}};
  const runtime::CompiledCurve rendered(truth);
  const Samples samples = sampled(24, kDepth, [&](double d) { return rendered.force(d); });
  const CurveFit fit = fit_curve(samples, {1e-4, 1e-5, 12, true}, "test");
  EXPECT_LE(fit.largest_error, 1e-4 * rendered.force(kDepth) + 1e-5);
  const std::vector<double> slopes = fit_slopes(samples, {0, 0.003, 0.006}, {1e-4, 1e-5, 12, true});
  EXPECT_NEAR(slopes[1], 120, 0.01);
  EXPECT_NEAR(slopes[2], 90, 0.02);
}

TEST(CurveFit, MakesAStraightLineOfASingleSample) {
  const CurveFit fit = fit_curve({{0.001, 0.2369}}, {0.01, 1e-3, 12, false}, "test");
  ASSERT_EQ(fit.curve.slope.size(), 2u);
  EXPECT_NEAR(fit.curve.slope[0], 236.9, 1e-2);
  EXPECT_NEAR(fit.curve.slope[1], 236.9, 1e-2);
}

TEST(CurveFit, NeedsOnlyTwoKnotsForAParabola) {
  const Samples samples = sampled(10, kDepth, [](double d) { return 9000 * d * d; });
  const CurveFit fit = fit_curve(samples, {0.001, 1e-6, 12, true}, "test");
  ASSERT_EQ(fit.curve.knot.size(), 2u);
  EXPECT_NEAR(fit.curve.slope[1], 2 * 9000 * kDepth, 1e-3);
}

/// Objective of fit_slopes by its definition, with the force integrated numerically.
double objective(const Samples& samples, const std::vector<double>& knots,
                 const std::vector<double>& slopes, const CurveFitSettings& settings) {
  const auto slope_at = [&](double d) {
    std::size_t k = 0;
    while (k + 2 < knots.size() && d > knots[k + 1]) ++k;
    const double t = (d - knots[k]) / (knots[k + 1] - knots[k]);
    return slopes[k] + t * (slopes[k + 1] - slopes[k]);
  };
  double sum = 0;
  double largest_tolerance = 0;
  for (const ForceSample& sample : samples) {
    const int steps = 4000;
    double force = 0;
    for (int i = 0; i < steps; ++i) {
      force += slope_at(sample.displacement * (i + 0.5) / steps) * sample.displacement / steps;
    }
    const double t =
        std::max(settings.relative_tolerance * std::abs(sample.force), settings.absolute_tolerance);
    largest_tolerance = std::max(largest_tolerance, t);
    sum += std::pow((force - sample.force) / t, 2);
  }
  for (std::size_t k = 1; k + 1 < knots.size(); ++k) {
    const double left = (slopes[k] - slopes[k - 1]) / (knots[k] - knots[k - 1]);
    const double right = (slopes[k + 1] - slopes[k]) / (knots[k + 1] - knots[k]);
    const double mean = 0.5 * (knots[k + 1] - knots[k - 1]);
    sum += std::pow(kKinkWeight * (right - left) * mean * mean / largest_tolerance, 2);
  }
  return sum;
}

TEST(CurveFit, NoisyFallingDataGiveTheMonotoneOptimum) {
  std::mt19937 engine(3);
  std::normal_distribution<double> noise(0, 0.02);
  // Falls in the second half: no monotone curve can follow it.
  const Samples samples = sampled(
      30, kDepth, [&](double d) { return 0.2 * std::sin(d / kDepth * 2.4) + noise(engine); });
  const CurveFitSettings settings{0.01, 0.005, 12, false};
  const std::vector<double> knots{0, 0.002, 0.004, 0.006};
  const std::vector<double> best = fit_slopes(samples, knots, settings);
  const double least = objective(samples, knots, best, settings);
  EXPECT_TRUE(std::any_of(best.begin(), best.end(), [](double s) { return s == 0; }));
  // The problem is convex: a minimum along every feasible direction is the minimum.
  std::uniform_real_distribution<double> step(-2, 2);
  for (int trial = 0; trial < 150; ++trial) {
    std::vector<double> other = best;
    for (double& slope : other)
      slope = std::max(0.0, slope + step(engine) * (trial % 2 ? 1 : 0.05));
    EXPECT_GE(objective(samples, knots, other, settings), least * (1 - 1e-6));
  }
}

TEST(CurveFit, NoiseDoesNotBecomeStiffness) {
  const Samples clean = sampled(40, kDepth, hertz);
  std::mt19937 engine(5);
  std::normal_distribution<double> noise(0, 0.004);
  double worst = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Samples samples = clean;
    for (ForceSample& sample : samples) sample.force += noise(engine);
    const CurveFit fit = fit_curve(samples, {0.01, 0.005, 12, true}, "test");
    expect_passive(fit.curve);
    worst = std::max(worst, runtime::CompiledCurve(fit.curve).max_slope());
  }
  // Secants between neighbours are up to twice as steep as the law; the fit must not follow them.
  EXPECT_LT(worst, 1.25 * largest_secant(clean));
  EXPECT_GT(worst, 0.9 * largest_secant(clean));
}

TEST(CurveFit, CoarseSamplesDoNotOvershoot) {
  // As many samples as a short campaign has, alternating by one tolerance about a line.
  Samples samples = sampled(6, kDepth, [](double d) { return 50 * d; });
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].force *= i % 2 == 0 ? 1.03 : 0.97;
  }
  const CurveFit fit = fit_curve(samples, {0.01, 1e-4, 12, false}, "test");
  EXPECT_LT(runtime::CompiledCurve(fit.curve).max_slope(), 1.5 * largest_secant(samples));
}

TEST(CurveFit, StatesTheErrorOfWhatIsStored) {
  const Samples samples = sampled(15, kDepth, hertz);
  const CurveFit fit = fit_curve(samples, {0.003, 1e-4, 12, true}, "test");
  const runtime::CompiledCurve rendered(fit.curve);
  double largest = 0;
  for (const ForceSample& sample : samples) {
    largest = std::max(largest, std::abs(rendered.force(sample.displacement) - sample.force));
  }
  EXPECT_DOUBLE_EQ(fit.largest_error, largest);
  // Written as double and read as float, the same numbers come back: they are floats already.
  for (const float slope : fit.curve.slope) EXPECT_EQ(static_cast<float>(double{slope}), slope);
}

TEST(CurveFit, StopsAtTheGivenNumberOfKnots) {
  const Samples samples = sampled(60, kDepth, [](double d) { return d < 0.003 ? 0.0 : 1.0; });
  const CurveFit fit = fit_curve(samples, {0.01, 1e-3, 6, true}, "test");
  EXPECT_LE(fit.curve.knot.size(), 6u);
  EXPECT_GT(fit.worst_ratio, 1);  // a jump cannot be followed, and that is said
  expect_passive(fit.curve);
}

TEST(CurveFit, OrderOfSamplesDoesNotMatter) {
  Samples samples = sampled(12, kDepth, hertz);
  const CurveFit sorted = fit_curve(samples, {0.01, 1e-4, 12, true}, "test");
  std::reverse(samples.begin(), samples.end());
  const CurveFit reversed = fit_curve(samples, {0.01, 1e-4, 12, true}, "test");
  EXPECT_EQ(sorted.curve.knot, reversed.curve.knot);
  EXPECT_EQ(sorted.curve.slope, reversed.curve.slope);
}

TEST(CurveFit, AllZeroForcesAreAFlatCurve) {
  const CurveFit fit = fit_curve(sampled(8, kDepth, [](double) { return 0.0; }), {}, "test");
  EXPECT_EQ(fit.largest_error, 0);
  EXPECT_EQ(runtime::CompiledCurve(fit.curve).max_slope(), 0);
}

/// The tolerance is a share of the curve's own force: a curve a thousandfold softer is fitted
/// alike.
TEST(CurveFit, WithoutAnAbsoluteToleranceFollowsSoftCurvesAsWellAsStiffOnes) {
  std::size_t knots = 0;
  for (const double scale : {1.0, 1.0 / 1024, 1.0 / (1 << 24), 4096.0}) {
    const Samples samples = sampled(12, kDepth, [&](double d) { return scale * hertz(d); });
    CurveFitSettings settings;
    settings.zero_first_slope = true;
    const CurveFit fit = fit_curve(samples, settings, "test");
    EXPECT_LE(fit.largest_error, 0.01 * scale * hertz(kDepth)) << scale;
    EXPECT_LE(fit.worst_ratio, 1) << scale;
    for (const ForceSample& sample : samples) {
      const double error =
          runtime::CompiledCurve(fit.curve).force(sample.displacement) - sample.force;
      EXPECT_LE(std::abs(error), std::max(0.01 * sample.force, 0.005 * scale * hertz(kDepth)));
    }
    if (knots == 0) knots = fit.curve.knot.size();
    EXPECT_EQ(fit.curve.knot.size(), knots) << scale;
  }
}

TEST(CurveFit, RefusesWhatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(fit_curve({{0.001, nan}}, {}, "site 4"), Error);
  EXPECT_THROW(fit_curve({{0, 0}}, {}, "site 4"), Error);
  try {
    fit_curve({}, {}, "site 4");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_EQ(error.where(), "site 4");
  }
}

}  // namespace
}  // namespace palpate::fitting
