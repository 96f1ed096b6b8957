// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "fitting/measurement/relaxation/history_model.hpp"
#include "tests/unit/fitting/measurement/relaxation/sphere_record.hpp"

namespace palpate::calibrate {
namespace {

/// The ramp has five samples: the elastic force is not linear between them.
TEST(HistoryModel, IsTheClosedFormOfASphereAtFewSamples) {
  const RampAndHold sphere{0.2, 1e-3, 0.4, {{0.35, 0.3}, {0.25, 6}}};
  const RelaxationRecord record = record_on(sphere, 10, 101, {});
  const HistoryModel model(record, 1e-3);
  const auto f = model.predict({0.2, 1.5, 0, {0.35, 0.25}, {0.3, 6}});
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_NEAR(f[i], sphere.force(record.time[i]), 1e-5);
}

void expect_slopes(const RelaxationRecord& record, double largest, double second) {
  const HistoryModel model(record, largest);
  const std::vector<double> at{0.3, 1.4, second, 0.3, 0.2, std::log(0.5), std::log(4.0)};
  const auto body = [](const std::vector<double>& c) {
    return BodyConstants<double>{c[0], c[1], c[2], {c[3], c[4]}, {std::exp(c[5]), std::exp(c[6])}};
  };
  std::vector<double> r(record.time.size()), slopes;
  model.differentiate(body(at), r.data(), slopes);
  for (std::size_t k = 0; k < at.size(); ++k) {
    std::vector<double> low = at, high = at;
    low[k] -= 1e-6;
    high[k] += 1e-6;
    const auto below = model.predict(body(low)), above = model.predict(body(high));
    for (std::size_t i = 5; i < record.time.size(); i += 7)
      EXPECT_NEAR(slopes[i * at.size() + k], (above[i] - below[i]) / 2e-6 / model.scale(), 2e-6);
  }
}

TEST(HistoryModel, HasTheDerivativesOfDifferences) {
  const RampAndHold sphere{0.2, 1e-3, 0.4, {{0.35, 0.3}}};
  expect_slopes(record_on(sphere, 10, 201, {}), 1e-3, 0.2);
  expect_slopes(creep_record({{0.4, 2}}, {}), 1e-3, 0.2);
}

/// A force that is held by a body with two powers: the travel whose elastic force is the one that
/// the Volterra equation asks for.
TEST(HistoryModel, InvertsBothPowers) {
  const RelaxationRecord record = creep_record({{0.4, 2}}, {});
  const HistoryModel model(record, 1e-3);
  const auto x = model.predict({2, 1.5, 0.3, {}, {}});
  for (std::size_t i = 50; i < x.size(); i += 50) {
    const double d = x[i] / 1e-3;
    EXPECT_NEAR(2 * (0.7 * std::pow(d, 1.5) + 0.3 * std::pow(d, 2.5)), record.force[i], 1e-12);
  }
}

TEST(HistoryModel, NeverPulls) {
  RelaxationRecord record;
  record.time = even_times(2, 201);
  for (const double t : record.time) record.travel.push_back(1e-3 * std::max(0.0, 1 - t));
  record.travel.front() = 0;
  record.force.assign(record.time.size(), 1);
  const HistoryModel model(record, 1e-3);
  const auto f = model.predict({1, 1.5, 0, {0.6}, {0.2}});
  EXPECT_GE(*std::min_element(f.begin(), f.end()), 0);
  EXPECT_EQ(f.back(), 0);
}

}  // namespace
}  // namespace palpate::calibrate
