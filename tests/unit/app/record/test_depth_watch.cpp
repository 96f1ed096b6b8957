// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/record/depth_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "app/run/live_session.hpp"
#include "runtime/devices/device_virtual.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

constexpr double kKnown = 0.02;  // m, last knot of the plate

/// A live session in which a stiff hand presses the plate to a depth.
SessionRecorder& press(SessionRecorder& recorder, double depth) {
  const palpate_library body(
      test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); }));
  runtime::SimulatedDeviceSettings held;
  held.damping = 2;
  held.hand_stiffness = 20000;
  held.hand_damping = 40;
  runtime::VirtualDevice device(held, 1000, [depth](double t) {
    return runtime::HandTarget{{0.04, 0.04, 0.001 - depth * std::min(t / 0.3, 1.0)}, {}};
  });
  LiveSettings settings;
  settings.contact.friction = 0.3;
  settings.search_rate = 0;
  settings.loop.rate = 1000;
  settings.loop.realtime.priority = 0;
  settings.loop.watchdog = settings.safety.watchdog = 10;
  settings.duration = 0.4;
  settings.safety.ramp = 0;
  device.open();
  const std::atomic<bool> stop{false};
  run_live(device, body, settings, recorder, stop);
  recorder.finish();
  return recorder;
}

TEST(DepthWatch, CountsTheStepsOfALiveSessionThatLieDeeperThanTheLastSample) {
  const samples::TemporaryFolder folder;
  SessionRecorder recorder(folder / "recording.h5", {});
  const DepthWatch& depths = press(recorder, 0.026).depths();
  const std::vector<RecordedStep> steps = read_recording(folder / "recording.h5").steps;
  const auto deep = std::count_if(steps.begin(), steps.end(),
                                  [](const RecordedStep& s) { return s.depth > kKnown; });
  EXPECT_GT(deep, 20);
  EXPECT_EQ(depths.beyond(), deep);
  EXPECT_LT(depths.beyond(), depths.contact());
  EXPECT_GT(depths.deepest(), kKnown);
  const std::string warning = depths.warning(kKnown, "press less deep");
  EXPECT_THAT(warning, testing::StartsWith(std::to_string(deep) + " of "));
  EXPECT_THAT(warning, testing::HasSubstr("extrapolated, not computed"));
  EXPECT_THAT(warning, testing::HasSubstr("known to 20.0 mm"));
  EXPECT_THAT(warning, testing::EndsWith("press less deep"));
}

TEST(DepthWatch, SaysNothingOfASessionWithinTheSamples) {
  const samples::TemporaryFolder folder;
  SessionRecorder recorder(folder / "recording.h5", {});
  const DepthWatch& depths = press(recorder, 0.01).depths();
  EXPECT_GT(depths.contact(), 20);
  EXPECT_EQ(depths.beyond(), 0);
  EXPECT_EQ(depths.warning(kKnown, "press less deep"), "");
}

}  // namespace
}  // namespace palpate::app
