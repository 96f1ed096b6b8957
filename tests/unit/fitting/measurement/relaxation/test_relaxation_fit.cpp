// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fitting/measurement/relaxation/relaxation_fit.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/relaxation/sphere_record.hpp"

namespace palpate::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

const RelaxationSeries kTissue{{0.35, 0.3}, {0.25, 6}};

TEST(RelaxationFit, FindsTheSeriesOfASphereThatIsHeld) {
  const RampAndHold sphere{0.2, 1e-3, 0.4, kTissue};
  const RelaxationFit fit = fit_relaxation({record_on(sphere, 30, 1500, {0.0, 0.0, 1})}, {});
  ASSERT_EQ(fit.series.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(fit.series[i].fraction, kTissue[i].fraction, 1e-3);
    EXPECT_NEAR(fit.series[i].time_s, kTissue[i].time_s, 1e-2 * kTissue[i].time_s);
  }
  EXPECT_NEAR(fit.exponent, 1.5, 2e-3);
  EXPECT_NEAR(fit.records[0].instantaneous.value, 0.2, 1e-3);
  EXPECT_NEAR(fit.records[0].long_term.value, 0.2 * 0.4, 1e-3);
}

/// An ideal step would take the force at the end of the ramp for the instantaneous one: the ramp of
/// 0.4 s has lost a seventh of it by then.
TEST(RelaxationFit, DoesNotTakeTheRampForAStep) {
  const RampAndHold sphere{0.2, 1e-3, 0.4, kTissue};
  EXPECT_LT(sphere.force(0.4), 0.87 * 0.2);
  const RelaxationFit fit = fit_relaxation({record_on(sphere, 30, 1500, {1e-3, 0.0, 1})}, {});
  EXPECT_LT(fit.records[0].instantaneous.low, 0.2);
  EXPECT_GT(fit.records[0].instantaneous.high, 0.2);
  EXPECT_NEAR(fit.records[0].instantaneous.value, 0.2, 0.006);
}

TEST(RelaxationFit, TakesAsManyTermsAsTheRecordShows) {
  for (const double r : {0.0, 0.8}) {
    const RampAndHold one{0.2, 1e-3, 0.4, {{0.5, 3}}};
    const RelaxationFit fit = fit_relaxation({record_on(one, 30, 1000, {1e-3, r, 7})}, {});
    EXPECT_EQ(fit.series.size(), 1U) << r;
    const RampAndHold two{0.2, 1e-3, 0.4, kTissue};
    EXPECT_EQ(fit_relaxation({record_on(two, 30, 1000, {1e-3, r, 7})}, {}).series.size(), 2U);
  }
}

TEST(RelaxationFit, OfSeveralRecordsHasOneSeries) {
  const RampAndHold fast{0.2, 1e-3, 0.1, kTissue}, slow{0.5, 0.6e-3, 2, kTissue};
  const RelaxationFit fit = fit_relaxation(
      {record_on(fast, 10, 800, {5e-4, 0, 3}), record_on(slow, 40, 800, {5e-4, 0, 4})}, {});
  ASSERT_EQ(fit.series.size(), 2U);
  EXPECT_NEAR(fit.series[0].fraction, 0.35, 0.02);
  EXPECT_NEAR(fit.series[1].time_s, 6, 0.5);
  // At the largest travel of both, the second body is (1/0.6)^1.5 of its own.
  EXPECT_NEAR(fit.records[1].instantaneous.value, 0.5 * std::pow(1 / 0.6, 1.5), 0.05);
}

TEST(RelaxationFit, OfCreepFollowsTheTravel) {
  const RelaxationFit fit = fit_relaxation({creep_record({{0.4, 2}}, {1e-3, 0, 5})}, {});
  ASSERT_EQ(fit.series.size(), 1U);
  EXPECT_NEAR(fit.series[0].fraction, 0.4, 0.01);
  EXPECT_NEAR(fit.series[0].time_s, 2, 0.1);
}

TEST(RelaxationFit, TakesTimesOnAGrid) {
  const RampAndHold sphere{0.2, 1e-3, 0.4, kTissue};
  RelaxationSettings settings;
  settings.times = {0.3, 1.5, 6};
  const RelaxationFit fit = fit_relaxation({record_on(sphere, 30, 1500, {2e-4, 0.0, 1})}, settings);
  double sum = 0;
  for (const RelaxationBranch& b : fit.series) {
    sum += b.fraction;
    EXPECT_GT(b.fraction, 0);
  }
  EXPECT_NEAR(sum, 0.6, 0.005);
  EXPECT_NEAR(fit.series.front().fraction, 0.35, 0.01);
  EXPECT_NEAR(fit.series.back().fraction, 0.25, 0.01);
}

TEST(RelaxationFit, SaysWhatARecordDoesNotShow) {
  const RampAndHold slow{0.2, 1e-3, 0.4, {{0.5, 80}}};
  const RelaxationFit fit = fit_relaxation({record_on(slow, 30, 1000, {2e-4, 0, 2})}, {});
  EXPECT_THAT(fit.calibration.warnings, Contains(HasSubstr("is longer than the record")));
  const RampAndHold quick{0.2, 1e-3, 2, {{0.5, 0.1}}};
  const RelaxationFit early = fit_relaxation({record_on(quick, 30, 3000, {2e-4, 0, 2})}, {});
  EXPECT_THAT(early.calibration.warnings,
              Contains(HasSubstr("is shorter than the record resolves")));
  EXPECT_NEAR(early.shortest, 0.2, 1e-9);
  EXPECT_NEAR(early.longest, 30, 0.1);
}

/// A weak term in noise: fitted, and said to be undetermined.
TEST(RelaxationFit, SaysThatATimeInNoiseIsNotDetermined) {
  const RampAndHold weak{0.2, 1e-3, 0.4, {{0.03, 3}}};
  RelaxationSettings settings;
  settings.terms = 1;
  settings.fit_exponent = false;
  const RelaxationFit fit = fit_relaxation({record_on(weak, 10, 200, {2e-2, 0, 8})}, settings);
  EXPECT_THAT(fit.calibration.warnings, Contains(HasSubstr("is not determined")));
}

TEST(RelaxationFit, RefusesAnElasticRecord) {
  const RampAndHold elastic{0.2, 1e-3, 0.4, {}};
  try {
    fit_relaxation({record_on(elastic, 30, 1000, {1e-3, 0, 2})}, {});
    FAIL() << "an elastic record relaxes";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no "));
  }
  EXPECT_THROW(fit_relaxation({}, {}), Error);
}

}  // namespace
}  // namespace palpate::calibrate
