// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "fitting/measurement/relaxation/series_starts.hpp"
#include "tests/unit/fitting/measurement/relaxation/sphere_record.hpp"

namespace palpate::calibrate {
namespace {

TEST(SeriesStarts, AreExactWhereTheTruthIsAmongTheTimes) {
  const RampAndHold sphere{0.2, 1e-3, 0.4, {{0.35, 0.3}, {0.25, 6}}};
  const RelaxationRecord record = record_on(sphere, 30, 600, {});
  const HistoryModel model(record, 1e-3);
  const auto starts = series_starts(model, {1, 1.5, 2}, {0.1, 0.3, 1, 6, 20}, 2, 3);
  ASSERT_EQ(starts.size(), 3U);
  EXPECT_EQ(starts[0].exponent, 1.5);
  EXPECT_EQ(starts[0].time, (std::vector<double>{0.3, 6}));
  EXPECT_NEAR(starts[0].fraction[0], 0.35, 1e-3);
  EXPECT_NEAR(starts[0].force, 0.2, 1e-4);
  EXPECT_LE(starts[0].misfit, starts[1].misfit);
}

TEST(SeriesStarts, AreNoneForMoreTermsThanTimes) {
  const RampAndHold sphere{0.2, 1e-3, 0.4, {{0.35, 0.3}}};
  const RelaxationRecord record = record_on(sphere, 10, 100, {});
  EXPECT_TRUE(series_starts(HistoryModel(record, 1e-3), {1.5}, {1}, 2, 3).empty());
}

}  // namespace
}  // namespace palpate::calibrate
