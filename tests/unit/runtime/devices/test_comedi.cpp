// SPDX-License-Identifier: AGPL-3.0-or-later
// The electronics by themselves; the device that they serve is in test_conformance.cpp. The fake
// board gives 200 000 counts a metre, 2 N/V, and +-10 V in 16 bits.
#include "runtime/devices/comedi.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "format/error.hpp"
#include "tests/unit/runtime/devices/vendor_world.hpp"

namespace palpate::test {
namespace {

using runtime::ComediElectronics;
using runtime::ComediSettings;

constexpr double kNewtonPerVolt = 2;
constexpr double kHalfStep = 0.5 * 20 / 65535 * kNewtonPerVolt;  // N

ComediSettings board(double amplifier) {
  ComediSettings settings;
  settings.library = PALPATE_FAKE_COMEDI;
  for (unsigned j = 0; j < 3; ++j) settings.channels.push_back({2, j, 1, j, amplifier});
  return settings;
}

class Comedi : public testing::Test {
 protected:
  void expect_refused(const ComediSettings& settings, const std::string& problem) {
    ComediElectronics electronics(settings);
    try {
      electronics.open();
      ADD_FAILURE() << "opened where " << problem;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(problem));
      EXPECT_THAT(error.what(), testing::HasSubstr("/dev/comedi0"));
    }
    EXPECT_EQ(world_.closed, world_.opened);
  }

  FakeWorld& world_ = fresh_world_of("LabOnComedi");
};

TEST_F(Comedi, WritesTheCurrentAsAVoltageOfTheAmplifier) {
  for (const double amplifier : {0.5, 1.0, -4.0}) {  // A/V
    ComediElectronics electronics(board(amplifier));
    electronics.open();
    const std::array<double, 3> current{0.3, -1.7, 2.5};
    ASSERT_TRUE(electronics.write_current(current));
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(world_.last_force()[j], kNewtonPerVolt * current[j] / amplifier,
                  1.01 * kHalfStep);
  }
}

TEST_F(Comedi, StaysInTheRangeOfTheOutput) {
  ComediElectronics electronics(board(1));
  electronics.open();
  ASSERT_TRUE(electronics.write_current(std::array<double, 3>{1e6, -1e6, 0}));
  EXPECT_NEAR(world_.last_force()[0], 10 * kNewtonPerVolt, kHalfStep);
  EXPECT_NEAR(world_.last_force()[1], -10 * kNewtonPerVolt, kHalfStep);
}

/// Counters of 24 bits run backwards from 2^24; LabDevice unwraps them.
TEST_F(Comedi, ReadsTheCountersAsTheyAre) {
  ComediElectronics electronics(board(1));
  electronics.open();
  world_.place({0.001, -0.001, 0}, {});
  std::array<std::int32_t, 3> counts{};
  ASSERT_TRUE(electronics.read_counts(counts));
  EXPECT_THAT(counts, testing::ElementsAre(200, (1 << 24) - 200, 0));
}

TEST_F(Comedi, DoesNothingBeforeItIsOpenAndWithAnotherNumberOfJoints) {
  ComediElectronics electronics(board(1));
  std::array<std::int32_t, 3> counts{};
  std::array<std::int32_t, 2> two{};
  EXPECT_FALSE(electronics.read_counts(counts));
  EXPECT_FALSE(electronics.write_current(std::array<double, 3>{}));
  electronics.open();
  EXPECT_TRUE(electronics.read_counts(counts));
  EXPECT_FALSE(electronics.read_counts(two));
  EXPECT_FALSE(electronics.write_current(std::array<double, 2>{}));
}

TEST_F(Comedi, RefusesAnAmplifierWithoutAmperesPerVolt) {
  for (const double amplifier :
       {0.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(ComediElectronics{board(amplifier)}, Error) << amplifier;
}

TEST_F(Comedi, ClosesABoardThatLacksWhatTheChannelsName) {
  ComediSettings no_output = board(1), no_counter = board(1);
  no_output.channels[1].output_channel = 7;
  expect_refused(no_output, "an output channel does not exist");
  no_counter.channels[2].counter_subdevice = 5;
  expect_refused(no_counter, "a counter does not take an encoder");
}

}  // namespace
}  // namespace palpate::test
