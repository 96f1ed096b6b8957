// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/onset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::measured {
namespace {

/// Samples every 10 um and 0.1 s to 2 mm; contact at 0.5 mm.
OnsetSamples onset(double p, double offset, double drift, double noise, unsigned seed = 1) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0, noise);
  OnsetSamples samples;
  for (int i = 0; i <= 200; ++i) {
    const double x = 10e-6 * i, t = 0.1 * i, z = std::max(0.0, 1e3 * (x - 0.5e-3));
    samples.time.push_back(t);
    samples.displacement.push_back(x);
    samples.force.push_back(offset + drift * t + 0.1 * std::pow(z, p) * (1 + 0.2 * z) +
                            (noise > 0 ? normal(engine) : 0));
    samples.free.push_back(0);
  }
  samples.stretches = {201};
  return samples;
}

TEST(Onset, WithoutNoiseTheUnknownsAreExact) {
  for (const double p : {1.0, 1.5, 2.0}) {
    const OnsetEstimate e = fit_onset(onset(p, 0.3, 0.002, 0), {p, true, true});
    EXPECT_NEAR(e.contact, 0.5e-3, 1e-9) << p;
    EXPECT_NEAR(e.offset, 0.3, 1e-7) << p;
    EXPECT_NEAR(e.drift, 0.002, 1e-7) << p;
    const OnsetEstimate still = fit_onset(onset(p, 0.3, 0, 0), {p, true, false});
    EXPECT_NEAR(still.contact, 0.5e-3, 1e-9) << p;
    EXPECT_EQ(still.drift, 0);
    const OnsetEstimate zeroed = fit_onset(onset(p, 0, 0, 0), {p, false, false});
    EXPECT_NEAR(zeroed.contact, 0.5e-3, 1e-9) << p;
    EXPECT_EQ(zeroed.offset, 0);
  }
}

/// The covariance is that of many repeats: of offset, contact point, and of the two together.
TEST(Onset, CovarianceIsThatOfRepeats) {
  constexpr int kTrials = 400;
  double aa = 0, ac = 0, cc = 0, stated_aa = 0, stated_ac = 0, stated_cc = 0;
  for (unsigned seed = 0; seed < kTrials; ++seed) {
    const OnsetEstimate e = fit_onset(onset(1.5, 0.3, 0, 2e-3, seed), {1.5, true, false});
    const double a = e.offset - 0.3, c = e.contact - 0.5e-3;
    aa += a * a / kTrials;
    ac += a * c / kTrials;
    cc += c * c / kTrials;
    stated_aa += e.covariance[0][0] / kTrials;
    stated_ac += e.covariance[0][2] / kTrials;
    stated_cc += e.covariance[2][2] / kTrials;
  }
  // The sample variance of 400 has a relative standard deviation of 7 %.
  EXPECT_NEAR(stated_aa / aa, 1, 0.2);
  EXPECT_NEAR(stated_cc / cc, 1, 0.25);
  EXPECT_NEAR(stated_ac / ac, 1, 0.4);
}

TEST(Onset, AParabolaIsNotStraight) {
  OnsetSamples line = onset(1.5, 0.3, 0.01, 1e-3);
  line.displacement.resize(50);
  line.force.resize(50);
  line.time.resize(50);
  line.free.assign(50, 1);
  line.stretches = {50};
  EXPECT_TRUE(is_straight(line));
  const OnsetEstimate fit = fit_baseline(line, true);
  EXPECT_NEAR(fit.drift, 0.01, 4 * std::sqrt(fit.covariance[1][1]));
  // Slope of a line through n even samples: s sqrt(12/n)/T.
  EXPECT_NEAR(std::sqrt(fit.covariance[1][1]), 1e-3 * std::sqrt(12 / 50.0) / 5, 0.3 * 1e-4);
  for (std::size_t i = 0; i < 50; ++i) line.force[i] += 1e-3 * line.time[i] * line.time[i];
  EXPECT_FALSE(is_straight(line));
}

}  // namespace
}  // namespace palpate::measured
