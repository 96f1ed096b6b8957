// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "fitting/measurement/compare/over_time.hpp"
#include "format/error.hpp"

namespace palpate::compare {
namespace {

using measured::PhaseKind;

/// Out of contact for 1 s, in within 1 s, held for 8 s while the force falls to 0.6, back in 1 s.
measured::History held() {
  measured::History h;
  for (int i = 0; i <= 1100; ++i) {
    const double t = 0.01 * i;
    const double x = t < 2 ? t - 1 : t < 10 ? 1 : 11 - t;
    const double left = 1 - 0.05 * std::clamp(t - 2, 0.0, 8.0);
    h.time.push_back(t);
    h.travel.push_back(1e-3 * x);
    h.force.push_back(std::max(0.0, x) * left);
  }
  h.phases = {{PhaseKind::Approach, 0, 101},
              {PhaseKind::Ramp, 101, 200},
              {PhaseKind::Hold, 200, 1000},
              {PhaseKind::Release, 1000, 1101}};
  return h;
}

TEST(OverTime, OfTheRecordItselfHasNoError) {
  const measured::History h = held();
  const TimeComparison c = over_time(h, h.force);
  EXPECT_EQ(c.rmse, 0);
  EXPECT_EQ(c.time.front(), h.time[101]);
  ASSERT_EQ(c.holds.size(), 1u);
  EXPECT_NEAR(c.holds[0].measured, 0.6, 5e-3);
  // Two triangles of 1 mm and 1 N, 0.6 N: what was put in less what came back.
  EXPECT_NEAR(c.measured_loss, 0.5e-3 * (1 - 0.6), 5e-6);
  EXPECT_EQ(c.model_loss, c.measured_loss);
}

TEST(OverTime, OfAnElasticModelSeesWhatItLacks) {
  const measured::History h = held();
  std::vector<double> elastic;
  for (const double x : h.travel) elastic.push_back(std::max(0.0, 1e3 * x));
  const TimeComparison c = over_time(h, elastic);
  EXPECT_NEAR(c.holds[0].model, 1, 1e-12);
  EXPECT_NEAR(c.model_loss, 0, 2e-5);
  EXPECT_NEAR(c.worst, 0.4, 1e-2);
  EXPECT_NEAR(c.worst_time, 10, 0.02);
  EXPECT_NEAR(c.peak_error, 0, 1e-9);
  EXPECT_GT(c.bias, 0);
}

TEST(OverTime, OfARecordWithoutAReleaseHasNoLoss) {
  measured::History h = held();
  h.phases.pop_back();
  EXPECT_TRUE(std::isnan(over_time(h, h.force).measured_loss));
  h.phases.clear();
  EXPECT_THROW(over_time(h, h.force), Error);
}

TEST(OverTime, NeedsTheCornersOfAMotionAlone) {
  const measured::History h = held();
  EXPECT_EQ(corners_of(h.time, h.travel, 1e-7), (std::vector<std::size_t>{0, 200, 1000, 1100}));
  EXPECT_EQ(corners_of(h.time, h.travel, 1).size(), 2u);
}

}  // namespace
}  // namespace palpate::compare
