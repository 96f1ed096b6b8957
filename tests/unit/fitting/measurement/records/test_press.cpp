// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/press.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/records/bench.hpp"

namespace palpate::measured {
namespace {

using testing::HasSubstr;

std::string refusal(const PressRecord& record, const PressSettings& settings = {}) {
  try {
    analyse_press(record, settings);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "accepted";
}

TEST(Press, FindsTheContactOfANoiselessSphere) {
  Bench bench;
  bench.noise = 0;
  const PressCurve curve = analyse_press(press_on(bench, 1), {});
  EXPECT_NEAR(curve.contact.displacement, bench.contact, 10e-6);
  EXPECT_NEAR(curve.baseline.offset, bench.offset, 1e-6);
  EXPECT_NEAR(curve.rate, bench.speed, 0.02 * bench.speed);
}

/// The stated uncertainty must be neither too small nor idle: of many noisy presses of a law that
/// is not the fitted one, 95 % should lie within two standard uncertainties, and the stated one
/// should be of the size of the real error.
TEST(Press, ContactUncertaintyIsHonest) {
  constexpr int kTrials = 200;
  int inside = 0;
  double squares = 0, stated = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Bench bench;
    bench.noise = trial % 2 == 0 ? 0.001 : 0.004;
    bench.contact = 0.0021 + 1e-6 * trial;
    const ContactPoint contact =
        analyse_press(press_on(bench, 100 + static_cast<unsigned>(trial)), {}).contact;
    const double error = contact.displacement - bench.contact;
    if (std::abs(error) <= 2 * contact.uncertainty) ++inside;
    squares += error * error / kTrials;
    stated += contact.uncertainty * contact.uncertainty / kTrials;
  }
  RecordProperty("inside", inside);
  EXPECT_GE(inside, 178);  // 95 % less four standard deviations of the binomial
  EXPECT_LT(stated, 4 * squares);
}

TEST(Press, AThresholdIsBiasedIntoTheSpecimen) {
  Bench bench;
  PressSettings settings;
  settings.method = ContactMethod::Threshold;
  settings.threshold = 0.02;
  const PressCurve curve = analyse_press(press_on(bench, 3), settings);
  EXPECT_GT(curve.contact.displacement, bench.contact + 50e-6);
}

TEST(Press, MeasuresTheDriftWithinItsUncertainty) {
  int inside = 0;
  constexpr int kTrials = 100;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    Bench bench;
    bench.drift = 0.002;
    const Baseline baseline = analyse_press(press_on(bench, 500 + trial), {}).baseline;
    if (std::abs(baseline.drift - bench.drift) <= 2 * baseline.drift_uncertainty) ++inside;
    EXPECT_NEAR(baseline.noise, bench.noise, 0.3 * bench.noise);
  }
  EXPECT_GE(inside, 86);
}

/// The forces at true depth are those of the specimen whatever the machine adds to them.
TEST(Press, DepthAndForceAreThoseOfTheSpecimen) {
  Bench bench;
  bench.compliance = 0.4e-3;
  bench.drift = 0.003;
  PressSettings settings;
  settings.compliance = bench.compliance;
  const PressCurve curve = analyse_press(press_on(bench, 7), settings);
  const double largest = sneddon_force(bench.depth, bench.radius, bench.modulus);
  for (const DepthForce& sample : curve.loading) {
    EXPECT_NEAR(sample.force, sneddon_force(sample.depth, bench.radius, bench.modulus),
                0.02 * largest);
  }
  settings.compliance = 0;
  const PressCurve uncorrected = analyse_press(press_on(bench, 7), settings);
  EXPECT_GT(uncorrected.loading.back().depth, 1.01 * bench.depth);
}

TEST(Press, BranchesAndLossAreTold) {
  Bench bench;
  bench.hold = 3;
  const PressCurve curve = analyse_press(press_on(bench, 9), {});
  EXPECT_NEAR(curve.work_returned / curve.work_loading, bench.loss, 0.02);
  EXPECT_NEAR(curve.loading.back().depth, bench.depth, 0.02 * bench.depth);
  EXPECT_NEAR(curve.rate, bench.speed, 0.03 * bench.speed);  // the hold is not part of it
}

/// A machine that waits for 20 s half way in, while the force relaxes by a fifth: the curve is that
/// of the moving tool.
TEST(Press, PausesInLoadingBelongToNoBranch) {
  Bench bench;
  bench.depth = 0.004;
  const PressRecord smooth = press_on(bench, 17);
  const double stop = bench.contact + 0.5 * bench.depth;
  const double held = sneddon_force(0.5 * bench.depth, bench.radius, bench.modulus);
  PressRecord record = smooth;
  const auto at = std::find_if(record.displacement.begin(), record.displacement.end(),
                               [&](double x) { return x >= stop; }) -
                  record.displacement.begin();
  for (std::size_t i = static_cast<std::size_t>(at); i < record.time.size(); ++i) {
    record.time[i] += 20;
  }
  std::vector<double> t, x, f;
  for (int i = 0; i < 1000; ++i) {
    t.push_back(smooth.time[static_cast<std::size_t>(at)] + 0.02 * i);
    x.push_back(stop);
    f.push_back(bench.offset + held * (1 - 0.2 * (1 - std::exp(-0.02 * i / 2))));
  }
  record.time.insert(record.time.begin() + at, t.begin(), t.end());
  record.displacement.insert(record.displacement.begin() + at, x.begin(), x.end());
  record.force.insert(record.force.begin() + at, f.begin(), f.end());
  const PressCurve curve = analyse_press(record, {});
  const double largest = sneddon_force(bench.depth, bench.radius, bench.modulus);
  for (const DepthForce& sample : curve.loading) {
    EXPECT_NEAR(sample.force, sneddon_force(sample.depth, bench.radius, bench.modulus),
                0.02 * largest);
  }
  const PressCurve without = analyse_press(smooth, {});
  EXPECT_NEAR(static_cast<double>(curve.loading.size()),
              static_cast<double>(without.loading.size()), 5);
}

TEST(Press, CyclesAreCounted) {
  Bench bench;
  bench.presses = 3;
  const PressRecord record = press_on(bench, 11);
  PressSettings settings;
  for (const int cycle : {1, 2, 3, -1, -3}) {
    settings.cycle = cycle;
    const PressCurve curve = analyse_press(record, settings);
    EXPECT_EQ(curve.cycles, 3);
    EXPECT_EQ(curve.cycle, cycle > 0 ? cycle : 4 + cycle);
    EXPECT_NEAR(curve.contact.displacement, bench.contact, 100e-6) << cycle;
  }
  settings.cycle = 4;
  EXPECT_THAT(refusal(record, settings), HasSubstr("there is no cycle 4, the record has 3"));
  settings.cycle = 0;
  EXPECT_THAT(refusal(record, settings), HasSubstr("no cycle 0"));
}

TEST(Press, SignsOfTheMachineDoNotMatter) {
  const PressRecord plain = press_on({}, 13);
  for (const double sx : {1.0, -1.0}) {
    for (const double sf : {1.0, -1.0}) {
      PressRecord record = plain;
      for (double& x : record.displacement) x = sx * x + 0.1;
      for (double& f : record.force) f *= sf;
      orient(record);
      const PressCurve curve = analyse_press(record, {});
      EXPECT_NEAR(curve.loading.back().depth, Bench{}.depth, 100e-6);
      EXPECT_GT(curve.loading.back().force, 0.1);
    }
  }
}

/// Two seconds of rest, a ramp of three, and a hold that has 98 % of the samples.
TEST(Press, SignsOfALongHoldAreFound) {
  for (const double sx : {1.0, -1.0}) {
    for (const double sf : {1.0, -1.0}) {
      PressRecord record{"hold", {}, {}, {}, {}};
      for (int i = 0; i < 3050; ++i) {
        const double t = 0.1 * i, ramp = std::clamp((t - 2) / 3, 0.0, 1.0);
        record.time.push_back(t);
        record.displacement.push_back(0.1 + sx * 2e-3 * ramp);
        record.force.push_back(0.02 + sf * ramp * (0.2 + 0.3 * std::exp(-std::max(0.0, t - 5))));
      }
      const Signs signs = orient(record);
      EXPECT_EQ(signs.displacement, sx);
      EXPECT_EQ(signs.force, sf);
      EXPECT_GT(record.displacement.back(), record.displacement.front());
      EXPECT_GT(record.force.back(), record.force.front());
    }
  }
}

TEST(Press, RefusesWhatCannotBeSortedOut) {
  Bench bench;
  bench.contact = -0.0005;
  EXPECT_THAT(refusal(press_on(bench, 1)), HasSubstr("begins in contact"));
  bench = {};
  bench.modulus = 1;
  EXPECT_THAT(refusal(press_on(bench, 1)), HasSubstr("never rises above its noise"));
  bench = {};
  bench.modulus *= 1000;  // a file in mN that is said to be in N
  PressSettings compliant;
  compliant.compliance = 0.05e-3;
  EXPECT_THAT(refusal(press_on(bench, 1), compliant), HasSubstr("check the units of force"));
  PressRecord reversed = press_on({}, 1);
  for (double& f : reversed.force) f = -f;
  EXPECT_THAT(refusal(reversed), HasSubstr("the force falls as the tool goes in"));
  PressSettings high;
  high.method = ContactMethod::Threshold;
  high.threshold = 1000;
  EXPECT_THAT(refusal(press_on({}, 1), high), HasSubstr("no force reaches the threshold"));
  PressSettings beyond;
  beyond.method = ContactMethod::Given;
  beyond.contact = 0.5;
  EXPECT_THAT(refusal(press_on({}, 1), beyond), HasSubstr("beyond the whole press"));
  PressRecord still = press_on({}, 1);
  still.displacement.assign(still.displacement.size(), 0.001);
  EXPECT_THAT(refusal(still), HasSubstr("no press"));
  PressRecord backwards = press_on({}, 1);
  std::swap(backwards.time[4], backwards.time[5]);
  EXPECT_THAT(refusal(backwards), HasSubstr("time goes backwards"));
  PressRecord uneven = press_on({}, 1);
  uneven.force.pop_back();
  EXPECT_THAT(refusal(uneven), HasSubstr("different lengths"));
}

}  // namespace
}  // namespace palpate::measured
