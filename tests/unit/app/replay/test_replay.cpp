// SPDX-License-Identifier: AGPL-3.0-or-later
// A session that was felt once is felt again to the bit, and a change of it is found.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/replay/replay.hpp"
#include "app/run/live_session.hpp"
#include "fitting/certificate/certify.hpp"
#include "format/error.hpp"
#include "runtime/devices/device_virtual.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/unit/app/run/live_play.hpp"

namespace palpate::app {
namespace {

class Replay : public testing::Test {
 protected:
  static Library plate() {
    Library library =
        test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
    fitting::certify(library, {0.3, {}});
    return library;
  }

  /// Pressed and slid by a hand, through clamp, ramp and a cut-off for speed.
  Recording live_session() {
    runtime::SimulatedDeviceSettings held;
    held.damping = 2;
    held.hand_stiffness = 400;
    held.hand_damping = 4;
    runtime::VirtualDevice device(held, 1000, [](double t) {
      const double x = 0.52 + 0.15 * std::max(0.0, t - 0.15);
      return runtime::HandTarget{{x, -0.21, 1.001 - 0.05 * std::min(t, 0.2)}, {0, 0, 0}};
    });
    LiveSettings settings;
    settings.contact.friction = 0.3;
    settings.contact.lipschitz_bound = body_.lipschitz_bound;
    settings.pose.position = {0.5, -0.25, 1};
    settings.search_rate = 0;
    settings.loop.rate = 1000;
    settings.loop.realtime.priority = 0;
    settings.loop.watchdog = 10;
    settings.safety.watchdog =
        0.01;  // on a busy machine a few steps are late: they are replayed too
    settings.safety.ramp = 0.05;
    settings.safety.max_force = 0.3;
    settings.duration = 0.4;
    const std::atomic<bool> stop{false};
    return play_live(device, body_, settings, stop).recording;
  }

  palpate_library body_{plate()};
};

TEST_F(Replay, GivesALiveSessionAgainToTheBit) {
  const Recording recorded = live_session();
  std::uint32_t seen = 0;
  double deepest = 0;
  for (const RecordedStep& step : recorded.steps) {
    seen |= step.status;
    deepest = std::max(deepest, step.depth);
  }
  ASSERT_TRUE(seen & PALPATE_CONTACT);
  ASSERT_TRUE(seen & PALPATE_LOOP_RAMPING);
  ASSERT_GT(deepest, 1e-4);
  const Recording again = replay(recorded, body_);
  const auto found = first_difference(recorded, again);
  EXPECT_FALSE(found) << found->what << " in step " << found->step << ": " << found->recorded
                      << " and " << found->replayed;
}

TEST_F(Replay, FindsTheSmallestChangeOfAForce) {
  Recording recorded = live_session();
  const Recording again = replay(recorded, body_);
  RecordedStep& step = recorded.steps[recorded.steps.size() / 2];
  step.force[1] = std::nextafter(step.force[1], 1.0);
  const auto found = first_difference(recorded, again);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->step, recorded.steps.size() / 2);
  EXPECT_EQ(found->what, "force[1]");
  EXPECT_THROW(refuse_difference(*found, recorded, "recording.h5"), Error);
}

TEST_F(Replay, AnotherFrictionIsAnotherSession) {
  Recording recorded = live_session();
  bool slid = false;
  for (const RecordedStep& step : recorded.steps) slid |= (step.status & PALPATE_SLIDING) != 0;
  ASSERT_TRUE(slid);
  recorded.friction = 0.1;
  EXPECT_TRUE(first_difference(recorded, replay(recorded, body_)));
}

TEST_F(Replay, FaultyReadingsAreReplayed) {
  Recording recorded = live_session();
  recorded.steps[recorded.steps.size() / 2].position[0] = std::numeric_limits<double>::quiet_NaN();
  const Recording first = replay(recorded, body_);
  EXPECT_FALSE(first_difference(first, replay(first, body_)));
  EXPECT_TRUE(first.steps[recorded.steps.size() / 2].status & PALPATE_BAD_INPUT);
}

}  // namespace
}  // namespace palpate::app
