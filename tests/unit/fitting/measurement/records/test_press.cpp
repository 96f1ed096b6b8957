// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/repeats.hpp"
#include "fitting/measurement/records/statistics.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/records/bench.hpp"

namespace palpate::measured {
namespace {

using testing::HasSubstr;

const Vec3 kInward{0, 0, -1};

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

TEST(Press, CyclesAreCounted) {
  Bench bench;
  bench.presses = 3;
  const PressRecord record = press_on(bench, 11);
  PressSettings settings;
  for (const int cycle : {1, 2, 3, -1, -3}) {
    settings.cycle = cycle;
    const PressCurve curve = analyse_press(record, settings);
    EXPECT_EQ(curve.cycles, 3);
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

std::vector<PressCurve> presses_of_site(int count, double scatter_of_modulus, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<PressCurve> presses;
  for (int i = 0; i < count; ++i) {
    Bench bench;
    bench.modulus *= 1 + scatter_of_modulus * normal(engine);
    presses.push_back(analyse_press(press_on(bench, seed + static_cast<unsigned>(i)), {}));
  }
  return presses;
}

/// The path is the record a simulation would give: from the touch, along inward, work and all.
TEST(Repeats, AreTheRecordOfASimulatedCurve) {
  const Bench bench;
  const CurvePath path = mean_path(presses_of_site(3, 0, 21), kInward, {}, "site");
  EXPECT_EQ(path.kind, PathKind::Normal);
  EXPECT_EQ(path.repeats, 3);
  ASSERT_EQ(path.samples.size(), 25U);
  EXPECT_EQ(path.samples.front().displacement, 0);
  EXPECT_EQ(norm(path.samples.front().force), 0);
  for (const CurveSample& sample : path.samples) {
    const double wanted = sneddon_force(sample.displacement, bench.radius, bench.modulus);
    EXPECT_NEAR(-sample.force[2], wanted, 4 * sample.force_uncertainty + 1e-9);
    EXPECT_EQ(sample.force[0], 0);
    EXPECT_TRUE(std::isnan(sample.strain_energy));
  }
  // Work: the closed form integrated over the depth.
  double work = 0;
  const double reach = path.samples.back().displacement;
  for (int i = 0; i < 1000; ++i) {
    work += sneddon_force(reach * (i + 0.5) / 1000, bench.radius, bench.modulus) * reach / 1000;
  }
  EXPECT_NEAR(path.samples.back().tool_work, work, 0.01 * work);
}

TEST(Repeats, ScatterIsThatOfTheSpecimens) {
  const auto presses = presses_of_site(40, 0.1, 31);
  const CurvePath path = mean_path(presses, kInward, {}, "site");
  const CurveSample& end = path.samples.back();
  const double relative = end.force_scatter / norm(end.force);
  EXPECT_NEAR(relative, 0.1, 0.035);  // three standard deviations of the scatter of forty
  EXPECT_NEAR(end.force_uncertainty, end.force_scatter / std::sqrt(40.0),
              0.05 * end.force_uncertainty);
}

/// One file of the repeats in another unit of length.
TEST(Repeats, RefusesPressesOfOtherDepths) {
  std::vector<PressCurve> presses = presses_of_site(2, 0, 61);
  for (DepthForce& sample : presses[1].loading) sample.depth *= 1000;
  try {
    mean_path(presses, kInward, {}, "site 4");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("check their units of length"));
  }
}

TEST(Repeats, OnePressHasNoScatterButAnUncertainty) {
  const CurvePath path = mean_path(presses_of_site(1, 0, 41), kInward, {}, "site");
  EXPECT_TRUE(std::isnan(path.samples.back().force_scatter));
  EXPECT_GT(path.samples.back().force_uncertainty, 0);
  EXPECT_GT(path.contact_uncertainty, 0);
}

/// Calibration of the load cell and compliance act on all presses alike: more presses do not help.
TEST(Repeats, CommonUncertaintiesDoNotAverageOut) {
  RepeatSettings settings;
  settings.force_calibration = 0.02;
  const CurvePath path = mean_path(presses_of_site(30, 0, 51), kInward, settings, "site");
  const CurveSample& end = path.samples.back();
  EXPECT_GE(end.force_uncertainty, 0.02 * norm(end.force));
  EXPECT_LT(end.force_uncertainty, 0.03 * norm(end.force));
}

/// The uncertainty of a mean of few presses covers the truth at all depths.
TEST(Repeats, UncertaintyCoversTheTruth) {
  int inside = 0, total = 0;
  const Bench bench;
  for (unsigned trial = 0; trial < 60; ++trial) {
    const CurvePath path = mean_path(presses_of_site(1, 0, 1000 + 10 * trial), kInward, {}, "s");
    for (std::size_t i = 4; i < path.samples.size(); i += 5) {
      const CurveSample& s = path.samples[i];
      const double error =
          norm(s.force) - sneddon_force(s.displacement, bench.radius, bench.modulus);
      if (std::abs(error) <= 2 * s.force_uncertainty) ++inside;
      ++total;
    }
  }
  RecordProperty("inside_percent", 100 * inside / total);
  EXPECT_GE(inside, 0.88 * total);
}

/// Mindlin's ratio of the tangential to the normal stiffness of a stuck contact, nu = 1/2.
TEST(Repeats, ALateralPathIsMadeFromTheNormalStiffness) {
  const CurvePath normal = mean_path(presses_of_site(3, 0, 71), kInward, {}, "site");
  const CurvePath lateral = lateral_from_normal(normal, 2.0 / 3);
  EXPECT_EQ(lateral.kind, PathKind::Lateral);
  EXPECT_EQ(lateral.repeats, 0);
  EXPECT_NEAR(dot(lateral.direction, kInward), 0, 1e-12);
  const double h = lateral.lateral_depth, e = 1e-5;
  const Bench bench;
  const double k = (sneddon_force(h + e, bench.radius, bench.modulus) -
                    sneddon_force(h - e, bench.radius, bench.modulus)) /
                   (2 * e);
  const CurveSample& end = lateral.samples.back();
  EXPECT_NEAR(dot(end.force, lateral.direction), 2.0 / 3 * k * end.displacement,
              0.05 * k * end.displacement);
}

TEST(Statistics, StudentQuantilesAreThoseOfTheTables) {
  // Abramowitz & Stegun 1964, table 26.10, two-sided 95 %.
  EXPECT_NEAR(student_quantile(0.95, 1), 12.706, 1e-3);
  EXPECT_NEAR(student_quantile(0.95, 5), 2.571, 1e-3);
  EXPECT_NEAR(student_quantile(0.95, 30), 2.042, 1e-3);
  EXPECT_NEAR(student_quantile(0.99, 10), 3.169, 1e-3);
}

}  // namespace
}  // namespace palpate::measured
