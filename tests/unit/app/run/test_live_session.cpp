// SPDX-License-Identifier: AGPL-3.0-or-later
// Live sessions: what is refused before a hand is put at risk, and what is kept when it goes wrong.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/run/certified.hpp"
#include "app/run/device_choice.hpp"
#include "app/run/live_session.hpp"
#include "fitting/certificate/certify.hpp"
#include "fitting/certificate/device_profile.hpp"
#include "format/error.hpp"
#include "runtime/devices/device_virtual.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/unit/app/run/live_play.hpp"

namespace palpate::app {
namespace {

fitting::DeviceProfile device_with(double damping) {
  fitting::DeviceProfile profile;
  profile.name = "a device";
  profile.damping = damping;
  return profile;
}

Library certified_plate() {
  Library library = test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
  fitting::certify(library, {0.3, {}});
  return library;
}

/// What the refusal says.
std::string refusal(const Library& library, double damping, double rate) {
  try {
    require_certified(library, "library.h5", device_with(damping), rate);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_NE(error.remedy().find("--uncertified"), std::string::npos);
    return error.what();
  }
  return "";
}

TEST(Certified, TheRateIsTwiceTheLipschitzBoundOverTheDamping) {
  const Library library = certified_plate();
  // On a plane L = max(L_stick, L_slip), both in the certificate; below 4 L_stick it is that.
  const double steepest = std::max(library.certificate.stick, library.certificate.slip);
  ASSERT_LT(steepest, 4 * library.certificate.stick);
  EXPECT_NEAR(certified_rate(library, device_with(0.5)), 2 * steepest / 0.5, 1e-9);
  const double needed = certified_rate(library, device_with(0.5));
  EXPECT_EQ(refusal(library, 0.5, needed * 1.001), "");
  // Between that and L_min slides are held back.
  const double held = 2 * library.certificate.min_lipschitz_bound / 0.5;
  EXPECT_NE(refusal(library, 0.5, held * 0.999).find("is not certified"), std::string::npos);
}

TEST(Certified, SlidesAreHeldBackAsFarAsTheRateAsks) {
  Library library = test::plate(
      8, 0.08, [](const Vec3& x) { return test::wall_response(170 + 1500 * x[0], 120); });
  fitting::certify(library, {0.3, {}});
  const Certificate& c = library.certificate;
  ASSERT_LT(1.01 * c.min_lipschitz_bound, c.lipschitz_bound);
  const fitting::DeviceProfile device = device_with(0.5);
  EXPECT_DOUBLE_EQ(lipschitz_bound_for(library, device, 2 * c.lipschitz_bound / 0.5 + 1),
                   c.lipschitz_bound);
  const double between = 2 * 0.5 * (c.min_lipschitz_bound + c.lipschitz_bound) / 0.5;
  EXPECT_NEAR(lipschitz_bound_for(library, device, between),
              0.5 * (c.min_lipschitz_bound + c.lipschitz_bound), 1e-9);
  EXPECT_EQ(refusal(library, 0.5, between), "");
  // Below what can be held nothing is certified, and nothing is gained by holding back.
  const double below = 2 * 0.99 * c.min_lipschitz_bound / 0.5;
  EXPECT_DOUBLE_EQ(lipschitz_bound_for(library, device, below), c.lipschitz_bound);
  EXPECT_NE(refusal(library, 0.5, below).find("is not certified"), std::string::npos);
  EXPECT_DOUBLE_EQ(lipschitz_bound_for(library, device_with(std::nan("")), 1e5), c.lipschitz_bound);
  library.certificate.min_lipschitz_bound = library.certificate.slip =
      std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(library, 0.5, 1e7).find("no rate is certified"), std::string::npos);
}

TEST(Certified, WhatIsNotKnownIsNotCertified) {
  Library bare = certified_plate();
  bare.certificate.triangles.clear();
  EXPECT_NE(refusal(bare, 0.5, 1e5).find("no certificate"), std::string::npos);
  EXPECT_NE(refusal(certified_plate(), std::nan(""), 1e5).find("damping"), std::string::npos);
}

LiveSettings quick(double duration) {
  LiveSettings settings;
  settings.contact.friction = 0.3;
  settings.loop.rate = 1000;
  settings.loop.realtime.priority = 0;
  settings.loop.watchdog = settings.safety.watchdog = 10;  // no opinion on this machine's pace
  settings.safety.ramp = 0;
  settings.duration = duration;
  return settings;
}

runtime::SimulatedDeviceSettings held() {
  runtime::SimulatedDeviceSettings settings;
  settings.damping = 2;
  settings.hand_stiffness = 400;
  settings.hand_damping = 4;
  return settings;
}

TEST(LiveSession, PressesAndRecordsInTheFrameOfTheDevice) {
  // The body is moved by the pose, the hand by as much.
  const palpate_library body(certified_plate());
  LiveSettings settings = quick(0.4);
  settings.pose.position = {0.5, -0.25, 1};
  settings.search_rate = 1000;
  runtime::VirtualDevice device(held(), 1000, [](double t) {
    return runtime::HandTarget{{0.54, -0.21, 1.001 - 0.03 * t}, {0, 0, -0.03}};
  });
  const std::atomic<bool> stop{false};
  const auto [outcome, recording] = play_live(device, body, settings, stop);
  const std::vector<RecordedStep>& steps = recording.steps;
  ASSERT_GT(steps.size(), 30U);
  EXPECT_EQ(steps.size(), outcome.counts.steps);
  const auto touching = [](const RecordedStep& s) { return (s.status & PALPATE_CONTACT) != 0; };
  const auto first = std::find_if(steps.begin(), steps.end(), touching);
  ASSERT_NE(first, steps.end());
  EXPECT_NEAR(first->contact_point[0], 0.54, 1e-6);
  EXPECT_NEAR(first->contact_point[2], 1.0, 1e-9);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_GT(steps[i].time_ns, steps[i - 1].time_ns);
  }
}

TEST(LiveSession, EndsWhenTold) {
  const palpate_library body(certified_plate());
  runtime::VirtualDevice device(held(), 1000, [](double) { return runtime::HandTarget{}; });
  const std::atomic<bool> stop{true};
  const LiveOutcome outcome = play_live(device, body, quick(0), stop).outcome;
  EXPECT_FALSE(outcome.counts.lost);
  EXPECT_FALSE(outcome.halted);
}

/// Goes away after some steps.
class FailingDevice : public runtime::VirtualDevice {
 public:
  using VirtualDevice::VirtualDevice;
  runtime::DeviceStatus read(runtime::DeviceReading& reading) noexcept override {
    return ++reads_ > 25 ? runtime::DeviceStatus::Lost : VirtualDevice::read(reading);
  }

 private:
  int reads_ = 0;
};

TEST(LiveSession, KeepsTheRecordOfALostDevice) {
  const palpate_library body(certified_plate());
  FailingDevice device(held(), 1000, [](double) { return runtime::HandTarget{}; });
  const std::atomic<bool> stop{false};
  const auto [outcome, recording] = play_live(device, body, quick(0), stop);
  EXPECT_TRUE(outcome.counts.lost);
  EXPECT_EQ(recording.steps.size(), 26U);
  EXPECT_TRUE(recording.steps.back().status & PALPATE_LOOP_DEVICE_LOST);
}

/// Remembers the last force.
class ListeningDevice : public runtime::VirtualDevice {
 public:
  using VirtualDevice::VirtualDevice;
  runtime::DeviceStatus command(const Vec3& force) noexcept override {
    last_ = force;
    return VirtualDevice::command(force);
  }
  const Vec3& last() const { return last_; }

 private:
  Vec3 last_{};
};

TEST(LiveSession, EndsWithoutForceWhenTheDiskIsFullAndKeepsWhatItTook) {
  const samples::TemporaryFolder folder;
  const palpate_library body(certified_plate());
  ListeningDevice device(held(), 1000, [](double) {
    return runtime::HandTarget{{0.04, 0.04, -0.003}, {}};
  });
  device.open();
  const LiveSettings settings = quick(0);
  RecordingHeading heading;
  heading.settings = session_settings(settings);
  const std::atomic<bool> stop{false};
  LiveOutcome outcome;
  {
    SessionRecorder recorder(folder / "recording.h5", heading);
    const samples::SmallDisk disk(200'000);  // about a thousand steps
    outcome = run_live(device, body, settings, recorder, stop);
  }
  ASSERT_TRUE(outcome.not_recorded);
  EXPECT_NE(std::string(outcome.not_recorded->what()).find("recording.journal"), std::string::npos);
  EXPECT_EQ(norm(device.last()), 0);
  const Recovered recovered = recover(folder / "recording.journal", folder / "recording.h5");
  const Recording recording = read_recording(folder / "recording.h5");
  EXPECT_EQ(recording.steps.size(), recovered.steps);
  EXPECT_GT(recovered.steps, 100U);
  EXPECT_LT(recovered.steps, outcome.counts.steps);
  EXPECT_EQ(recording.provenance.steps.back().stage, "recover");
  EXPECT_FALSE(std::filesystem::exists(folder / "recording.journal"));
}

TEST(DeviceChoice, KnowsEveryNameItLists) {
  for (const DeviceName& device : device_names()) {
    DeviceChoice choice;
    choice.name = device.name;
    if (device.name == "lab") continue;  // below
    EXPECT_NE(make_device(choice, [](double) { return runtime::HandTarget{}; }), nullptr);
  }
  DeviceChoice typo;
  typo.name = "simulatd";
  try {
    make_device(typo, {});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(error.remedy().find("'simulated'"), std::string::npos);
  }
  for (const auto& [product, binding] :
       {std::pair{"Falcon", "'force-dimension'"}, std::pair{"touch", "'openhaptics'"},
        std::pair{"inverse3", "'haply'"}}) {
    try {
      require_known_device(product);
      ADD_FAILURE() << product;
    } catch (const Error& error) {
      EXPECT_NE(error.remedy().find(binding), std::string::npos) << error.remedy();
    }
  }
  DeviceChoice number;
  number.name = "force-dimension";
  number.unit = "left";
  EXPECT_THROW(make_device(number, {}), Error);
}

class LabDeviceFile : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  std::unique_ptr<runtime::Device> read(const std::string& text) {
    std::ofstream(file_) << text;
    return read_lab_device(file_.string(), "");
  }
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("lab_" + std::to_string(getpid()) + ".toml");
  const std::string good_ = R"(
name = "plane arm"
home = ["300 mm", "0 mm", "0 mm"]
[[joint]]
axis = [0, 0, 1]
counts_per_turn = 4000
torque_constant = 0.05
current_limit = 2
amplifier = 0.4
counter_subdevice = 2
counter_channel = 0
output_subdevice = 1
output_channel = 0
)";
};

TEST_F(LabDeviceFile, IsRead) {
  EXPECT_EQ(read(good_)->name(), "plane arm");
}

TEST_F(LabDeviceFile, IsRefusedWithTheReason) {
  const auto reason = [&](const std::string& text) -> std::string {
    try {
      read(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(reason(good_ + "gaer = 3\n").find("gear"), std::string::npos);
  EXPECT_NE(reason(good_ + "counter_bits = 64\n").find("counter_bits"), std::string::npos);
  EXPECT_NE(reason("name = \"x\"\nhome = [\"0 mm\", \"0 mm\", \"0 mm\"]\n").find("joint"),
            std::string::npos);
  EXPECT_THROW(read_lab_device("", ""), Error);
  EXPECT_THROW(read_lab_device("/nonexistent/lab.toml", ""), Error);
}

}  // namespace
}  // namespace palpate::app
