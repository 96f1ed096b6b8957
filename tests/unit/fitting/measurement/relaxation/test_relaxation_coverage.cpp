// SPDX-License-Identifier: AGPL-3.0-or-later
// How often the intervals of a series contain the truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/measurement/relaxation/relaxation_fit.hpp"
#include "tests/unit/fitting/measurement/relaxation/sphere_record.hpp"

namespace palpate::calibrate {
namespace {

/// How many of 100 repeats have an interval that holds the true value, for each constant of the
/// series, the instantaneous and the long-term force.
std::vector<int> covered(double correlation) {
  const RampAndHold sphere{0.2, 1e-3, 0.4, {{0.35, 0.5}, {0.25, 6}}};
  RelaxationSettings settings;
  settings.terms = 2;
  const std::vector<std::pair<std::string, double>> truth{
      {"fraction_1", 0.35}, {"fraction_2", 0.25}, {"time_1", 0.5}, {"time_2", 6}};
  std::vector<int> hits(truth.size() + 2, 0);
  for (unsigned repeat = 0; repeat < 100; ++repeat) {
    const RelaxationFit fit =
        fit_relaxation({record_on(sphere, 30, 400, {5e-3, correlation, 100 + repeat})}, settings);
    for (std::size_t k = 0; k < truth.size(); ++k)
      for (const Estimate& e : fit.calibration.estimates)
        if (e.name == truth[k].first && e.low <= truth[k].second && truth[k].second <= e.high)
          ++hits[k];
    const FittedRecord& record = fit.records[0];
    const auto holds = [](const Interval& i, double value) {
      return i.low <= value && value <= i.high ? 1 : 0;
    };
    hits[truth.size()] += holds(record.instantaneous, 0.2);
    hits[truth.size() + 1] += holds(record.long_term, 0.2 * 0.4);
  }
  return hits;
}

/// Between 90 and 99 of 100 intervals of 95 % cover, with a chance of 98 %.
TEST(RelaxationCoverage, IsThatOfTheConfidenceForIndependentNoise) {
  EXPECT_THAT(covered(0), testing::Each(testing::AllOf(testing::Ge(90), testing::Le(99))));
}

TEST(RelaxationCoverage, IsThatOfTheConfidenceForCorrelatedNoise) {
  EXPECT_THAT(covered(0.7), testing::Each(testing::AllOf(testing::Ge(90), testing::Le(99))));
}

}  // namespace
}  // namespace palpate::calibrate
