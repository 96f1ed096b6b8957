// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "fitting/measurement/relaxation/relaxation_record.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/relaxation/lee_radok.hpp"

namespace palpate::calibrate {
namespace {

using measured::Phase;
using measured::PhaseKind;

/// Approach to 1 s, ramp to 2 s, hold to 8 s, release.
measured::History held() {
  measured::History h;
  h.name = "held";
  h.time = even_times(10, 1001);
  for (const double t : h.time) {
    h.travel.push_back(t < 2 ? t - 1 : t < 8 ? 1 : 9 - t);
    h.force.push_back(std::max(0.0, h.travel.back()));
  }
  h.phases = {{PhaseKind::Approach, 0, 101},
              {PhaseKind::Ramp, 101, 200},
              {PhaseKind::Hold, 200, 800},
              {PhaseKind::Release, 800, 1001}};
  return h;
}

TEST(RelaxationRecord, GoesFromTheContactToTheEndOfTheHold) {
  const RelaxationRecord record = relaxation_record(held());
  EXPECT_NEAR(record.time.front(), 1, 0.011);
  EXPECT_NEAR(record.time.back(), 8, 0.011);
  EXPECT_NEAR(record.ramp, 1, 0.02);
  EXPECT_EQ(record.travel.front(), 0);
  EXPECT_NEAR(record.interval(), 0.01, 1e-12);
  EXPECT_FALSE(record.force_is_held);
  const RelaxationRecord thin = relaxation_record(held(), 100);
  EXPECT_EQ(thin.stride, 7U);
  EXPECT_LE(thin.time.size(), 101U);
}

TEST(RelaxationRecord, OfCyclesGoesToTheEnd) {
  measured::History h = held();
  h.phases = {{PhaseKind::Ramp, 101, 200},
              {PhaseKind::Release, 200, 400},
              {PhaseKind::Ramp, 400, 800},
              {PhaseKind::Release, 800, 1001}};
  EXPECT_NEAR(relaxation_record(h).time.back(), 10, 1e-9);
}

TEST(RelaxationRecord, NeedsTheRamp) {
  measured::History h = held();
  for (double& x : h.travel) x = std::max(x, 0.5);
  EXPECT_THROW(relaxation_record(h), Error);
}

}  // namespace
}  // namespace palpate::calibrate
