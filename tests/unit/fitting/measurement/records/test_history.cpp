// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fitting/measurement/records/history.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/records/bench.hpp"

namespace palpate::measured {
namespace {

using testing::HasSubstr;

std::string fault_of(const PressRecord& record, const HistorySettings& settings = {}) {
  try {
    require_time_dependence(analyse_history(record, settings));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(History, KeepsAllSamplesFromTheContactPointOfThePress) {
  Bench bench;
  bench.hold = 20;
  bench.compliance = 2e-5;
  bench.drift = 1e-4;
  const PressRecord record = press_on(bench, 3);
  HistorySettings settings;
  settings.press.compliance = bench.compliance;
  const History history = analyse_history(record, settings);
  const PressCurve curve = analyse_press(record, settings.press);
  EXPECT_EQ(history.time, record.time);
  EXPECT_EQ(history.contact.displacement, curve.contact.displacement);
  EXPECT_EQ(history.baseline.offset, curve.baseline.offset);
  // The loading branch is a part of the history, sample by sample.
  std::size_t at = 0;
  while (history.travel[at] < 0) ++at;
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_DOUBLE_EQ(history.travel[at + i], curve.loading[i].depth);
    EXPECT_DOUBLE_EQ(history.force[at + i], curve.loading[i].force);
  }
  EXPECT_EQ(history.control, Control::Travel);
  EXPECT_EQ(fault_of(record, settings), "");
}

/// A drift that an approach of two seconds shows to the noise of one sample would be off by many of
/// them after a hold of a hundred.
TEST(History, RemovesNoDriftThatALongHoldMakesUnknown) {
  Bench bench;
  bench.hold = 100;
  PressRecord record = press_on(bench, 3);
  const std::size_t kept = 5300;  // without the release
  for (auto* column : {&record.time, &record.displacement, &record.force}) column->resize(kept);
  const History history = analyse_history(record, {});
  EXPECT_EQ(history.baseline.drift, 0);
  const double deepest = sneddon_force(bench.depth, bench.radius, bench.modulus);
  EXPECT_NEAR(history.force.back(), deepest, 5 * bench.noise);
  EXPECT_NEAR(history.travel.back(), bench.depth, 2e-4);
}

TEST(History, TakesDeclaredPhases) {
  Bench bench;
  bench.hold = 20;
  HistorySettings settings;
  settings.declared = {{PhaseKind::Ramp, 2.3, 6.3}, {PhaseKind::Hold, 6.3, 10}};
  const History history = analyse_history(press_on(bench, 3), settings);
  ASSERT_EQ(history.phases.size(), 2U);
  EXPECT_NEAR(history.time[history.phases[1].begin], 6.3, 0.021);
  EXPECT_NEAR(history.time[history.phases[1].end], 10, 0.021);
  settings.declared[1].from = 5;
  EXPECT_THAT(fault_of(press_on(bench, 3), settings), HasSubstr("overlaps the phase before it"));
  settings.declared = {{PhaseKind::Hold, 500, 600}};
  EXPECT_THAT(fault_of(press_on(bench, 3), settings), HasSubstr("holds no sample"));
}

TEST(History, RefusesRecordsWithoutAUsableTime) {
  Bench bench;
  bench.hold = 20;
  const PressRecord good = press_on(bench, 3);
  PressRecord bad = good;
  bad.time.clear();
  EXPECT_THAT(fault_of(bad), HasSubstr("it has no time"));
  bad = good;
  bad.time[7] = bad.time[6];
  EXPECT_THAT(fault_of(bad), HasSubstr("does not increase at sample 8"));
  bad = good;
  bad.force[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(fault_of(bad), HasSubstr("sample 5 is not a finite number"));
  bad = good;
  bad.force.pop_back();
  EXPECT_THAT(fault_of(bad), HasSubstr("different lengths"));
}

TEST(History, RefusesARecordThatShowsNoTimeDependence) {
  Bench bench;
  EXPECT_THAT(fault_of(press_on(bench, 3)), HasSubstr("no hold in contact and fewer than two"));
  bench.presses = 3;
  EXPECT_EQ(fault_of(press_on(bench, 3)), "");
  bench.presses = 1;
  bench.hold = 2.5;  // the ramp takes 4 s
  EXPECT_THAT(fault_of(press_on(bench, 3)), HasSubstr("shorter than the ramp"));
}

}  // namespace
}  // namespace palpate::measured
