// SPDX-License-Identifier: AGPL-3.0-or-later
// Repeated synthetic presses of a known force: how often the stated uncertainties hold it.
#include "fitting/measurement/records/baseline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "fitting/measurement/records/repeats.hpp"
#include "format/error.hpp"

namespace palpate::measured {
namespace {

/// 0.05 N at 1 mm, as the power 1.5 of the depth, to 8 mm in 80 s.
struct SlowPress {
  double approach = 0.15e-3;  ///< m
  bool has_time = true, release = false;
  double drift = 0;            ///< N/s
  double noise = 0.005;        ///< N
  double autocorrelation = 0;  ///< of the noise of neighbouring samples
  double wait = 0;             ///< s, at the start
  double depth = 8e-3, speed = 0.1e-3, rate = 20;
  double offset = 0.3;
};

double force_at(double depth) {
  return depth > 0 ? 0.05 * std::pow(1e3 * depth, 1.5) : 0;
}

PressRecord record_of(const SlowPress& press, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0, 1);
  PressRecord record;
  record.name = "slow";
  const double leg = (press.approach + press.depth) / press.speed;
  const double duration = press.wait + (press.release ? 2 : 1) * leg;
  double noise = press.noise * normal(engine);
  const double r = press.autocorrelation;
  for (int i = 0; i <= static_cast<int>(duration * press.rate); ++i) {
    const double t = i / press.rate, moving = std::max(0.0, t - press.wait);
    const double x = press.speed * (moving < leg ? moving : 2 * leg - moving);
    if (press.has_time) record.time.push_back(t);
    record.displacement.push_back(x);
    record.force.push_back(press.offset + press.drift * t + force_at(x - press.approach) + noise);
    noise = r * noise + std::sqrt(1 - r * r) * press.noise * normal(engine);
  }
  return record;
}

/// How many of 100 presses lie within two stated uncertainties, and the median of those.
struct Coverage {
  int forces = 0, contacts = 0;
  double error = 0, shift = 0;  ///< root mean square, N, m
  double stated_force = 0, stated_contact = 0;
  std::array<int, 4> states{};  ///< by DriftState

  int of(DriftState state) const { return states[static_cast<std::size_t>(state)]; }
};

double median_of(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + 50, values.end());
  return values[50];
}

Coverage coverage_of(const SlowPress& press) {
  Coverage c;
  std::vector<double> forces, contacts;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const PressCurve curve = analyse_press(record_of(press, 7919 * seed + 1), {});
    const CurvePath path = mean_path({curve}, {0, 0, -1}, {}, "site");
    const CurveSample& end = path.samples.back();
    const double error = -end.force[2] - force_at(end.displacement);
    const double shift = curve.contact.displacement - press.approach;
    forces.push_back(end.force_uncertainty);
    contacts.push_back(curve.contact.uncertainty);
    if (std::abs(error) <= 2 * forces.back()) ++c.forces;
    if (std::abs(shift) <= 2 * contacts.back()) ++c.contacts;
    c.error += error * error / 100;
    c.shift += shift * shift / 100;
    ++c.states[static_cast<std::size_t>(curve.baseline.state)];
  }
  c.error = std::sqrt(c.error);
  c.shift = std::sqrt(c.shift);
  c.stated_force = median_of(forces);
  c.stated_contact = median_of(contacts);
  return c;
}

/// Neither too small nor idle. 90 of 100 is 95 less two standard deviations of the binomial.
void expect_honest(const Coverage& c) {
  EXPECT_GE(c.forces, 90);
  EXPECT_GE(c.contacts, 90);
  EXPECT_LT(c.stated_force, 1.4 * c.error);
  EXPECT_LT(c.stated_contact, 1.4 * c.shift);
}

/// A drift that is not there is not extrapolated, however short the approach is.
TEST(Baseline, CoversWithoutDriftForEveryLengthOfApproach) {
  for (const double approach : {0.15e-3, 0.5e-3, 2e-3}) {
    for (const auto& [has_time, release] :
         {std::pair{true, true}, {true, false}, {false, true}, {false, false}}) {
      SCOPED_TRACE(testing::Message()
                   << 1e3 * approach << " mm, time " << has_time << ", release " << release);
      SlowPress press;
      press.approach = approach;
      press.has_time = has_time;
      press.release = release;
      expect_honest(coverage_of(press));
    }
  }
}

TEST(Baseline, RemovesADriftThatTheReleaseDetermines) {
  for (const double approach : {0.15e-3, 0.5e-3}) {
    SlowPress press;
    press.approach = approach;
    press.release = true;
    press.drift = 0.5e-3;  // 43 mN until the deepest point, of 1.13 N
    const Coverage c = coverage_of(press);
    expect_honest(c);
    EXPECT_GE(c.of(DriftState::Fitted), 98);
  }
}

/// A wait of a minute before the press determines the drift as well as a release does.
TEST(Baseline, RemovesADriftThatALongBaselineDetermines) {
  SlowPress press;
  press.wait = 60;
  press.drift = -0.5e-3;
  const Coverage c = coverage_of(press);
  expect_honest(c);
  EXPECT_EQ(c.of(DriftState::Fitted), 100);
}

/// What is seen and not determined is not removed, and counts.
TEST(Baseline, ASuspectedDriftIsInTheUncertainty) {
  SlowPress press;
  press.approach = 0.5e-3;
  press.drift = 6e-3;
  const Coverage seen = coverage_of(press);
  EXPECT_GE(seen.of(DriftState::Suspected) + seen.of(DriftState::Fitted), 90);
  EXPECT_GE(seen.forces, 90);
  EXPECT_GE(seen.contacts, 90);
  press.has_time = false;  // the force after the release is another one
  press.release = true;
  const Coverage without_time = coverage_of(press);
  EXPECT_GE(without_time.of(DriftState::Suspected), 90);
  EXPECT_GE(without_time.forces, 90);
}

TEST(Baseline, SaysWhichDriftIsNotExcluded) {
  SlowPress press;
  press.drift = 0.3e-3;
  int above = 0, undetermined = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Baseline b = analyse_press(record_of(press, seed), {}).baseline;
    if (b.state != DriftState::Undetermined) continue;
    ++undetermined;
    EXPECT_EQ(b.drift, 0);
    if (b.possible_drift > press.drift) ++above;
  }
  EXPECT_GE(undetermined, 80);
  EXPECT_GE(above, 0.95 * undetermined);
}

/// Noise that follows itself carries less information than as many independent samples.
TEST(Baseline, CoversWithCorrelatedNoise) {
  for (const bool release : {true, false}) {
    SlowPress press;
    press.approach = 2e-3;
    press.autocorrelation = 0.7;
    press.release = release;
    expect_honest(coverage_of(press));
  }
}

/// The same press, cut where the tool touches, with the force set to zero there by the machine.
PressRecord begun_in_contact(unsigned seed) {
  SlowPress press;
  press.approach = 0;
  press.offset = 0;
  return record_of(press, seed);
}

TEST(Baseline, AGivenContactPointAndAZeroedForceNeedNoApproach) {
  PressSettings settings;
  settings.method = ContactMethod::Given;
  settings.contact_uncertainty = 20e-6;
  settings.baseline = BaselineMethod::Zeroed;
  settings.zero_uncertainty = 1e-3;
  const PressCurve curve = analyse_press(begun_in_contact(3), settings);
  EXPECT_EQ(curve.contact.displacement, 0);
  EXPECT_EQ(curve.contact.uncertainty, 20e-6);
  EXPECT_EQ(curve.baseline.offset, 0);
  const CurveSample end = mean_path({curve}, {0, 0, -1}, {}, "site").samples.back();
  EXPECT_NEAR(-end.force[2], force_at(8e-3), 3e-3);
  // 1 mN of the zero, and 20 um at a slope of 1.5 F/d; the noise of 66 samples at their end.
  const double shift = 20e-6 * 1.5 * force_at(8e-3) / 8e-3;
  EXPECT_NEAR(end.force_uncertainty, std::hypot(1e-3, shift, 2 * 5e-3 / std::sqrt(33.0)), 8e-4);
  settings.contact_uncertainty = settings.zero_uncertainty = 0;
  EXPECT_LT(mean_path({analyse_press(begun_in_contact(3), settings)}, {0, 0, -1}, {}, "site")
                .samples.back()
                .force_uncertainty,
            end.force_uncertainty);
}

/// A given contact point with an approach: its baseline is that of the samples before it.
TEST(Baseline, AGivenContactPointLeavesTheBaselineToTheApproach) {
  SlowPress press;
  press.approach = 1e-3;
  PressSettings settings;
  settings.method = ContactMethod::Given;
  settings.contact = 1e-3;
  const PressCurve curve = analyse_press(record_of(press, 5), settings);
  EXPECT_NEAR(curve.baseline.offset, press.offset, 4 * 5e-3 / std::sqrt(200.0));
  settings.contact = 0;
  EXPECT_THROW(analyse_press(record_of(press, 5), settings), Error);
}

/// Two or three samples a step scatter about their line by chance: the noise of the record counts.
TEST(Baseline, CoversSlowRecordsWithAGivenContactPoint) {
  PressSettings settings;
  settings.method = ContactMethod::Given;
  settings.baseline = BaselineMethod::Zeroed;
  for (const double rate : {1.0, 0.6, 0.35, 0.2}) {
    SlowPress press;
    press.approach = press.offset = 0;
    press.rate = rate;
    int inside = 0, samples = 0;
    for (unsigned seed = 0; seed < 100; ++seed) {
      const PressCurve curve = analyse_press(record_of(press, 7919 * seed + 1), settings);
      const CurvePath path = mean_path({curve}, {0, 0, -1}, {}, "site");
      for (auto sample = path.samples.begin() + 1; sample != path.samples.end(); ++sample) {
        const double error = -sample->force[2] - force_at(sample->displacement);
        inside += std::abs(error) <= 2 * sample->force_uncertainty ? 1 : 0;
        ++samples;
      }
    }
    EXPECT_GE(inside, 0.9 * samples) << rate;
    EXPECT_LE(inside, 0.99 * samples) << rate;
  }
}

/// A specimen between grips has no approach: it waits at the point that is given, and that wait is
/// its baseline.
TEST(Baseline, AWaitAtAGivenContactPointIsTheBaseline) {
  SlowPress press;
  press.approach = 0;
  press.wait = 10;
  PressSettings settings;
  settings.method = ContactMethod::Given;
  const PressCurve curve = analyse_press(record_of(press, 7), settings);
  EXPECT_NEAR(curve.baseline.offset, press.offset, 4 * 5e-3 / std::sqrt(200.0));
}

}  // namespace
}  // namespace palpate::measured
