// SPDX-License-Identifier: AGPL-3.0-or-later
// Settings of a session that are refused before it begins.
#include "app/run/limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "format/error.hpp"

namespace palpate::app {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

struct Setting {
  const char* option;
  std::function<double&(LiveSettings&)> of;
  std::vector<double> bad, good;
};

std::vector<Setting> settings() {
  return {
      {"--rate", [](LiveSettings& s) -> double& { return s.loop.rate; }, {0, -1, 1e6}, {1, 20000}},
      {"--duration", [](LiveSettings& s) -> double& { return s.duration; }, {-1, 1e300}, {0, 4}},
      {"--friction",
       [](LiveSettings& s) -> double& { return s.contact.friction; },
       {-1, 1e9},
       {0, 1.5}},
      {"--max-force",
       [](LiveSettings& s) -> double& { return s.safety.max_force; },
       {-1, 0},
       {0.5, kEndless}},
      {"--max-speed",
       [](LiveSettings& s) -> double& { return s.safety.max_speed; },
       {-1, 0, 1e9},
       {0.5}},
      {"--ramp", [](LiveSettings& s) -> double& { return s.safety.ramp; }, {-1, 1e9}, {0, 2}},
      {"--watchdog",
       [](LiveSettings& s) -> double& { return s.safety.watchdog; },
       {-1, 0, 1e9},
       {0.02, 60}},
      {"--search-rate",
       [](LiveSettings& s) -> double& { return s.search_rate; },
       {-1, 1e12},
       {0, 500}},
      {"--at-mm",
       [](LiveSettings& s) -> double& { return s.pose.position[1]; },
       {-1e297, 11},
       {0, -0.25}},
  };
}

TEST(SessionLimits, TheDefaultsAreWithinThem) {
  EXPECT_NO_THROW(require_within_limits({}));
}

TEST(SessionLimits, EachOptionIsRefusedByItsNameOutsideItsRangeAndForNaN) {
  for (Setting& setting : settings()) {
    setting.bad.push_back(kNotANumber);
    setting.bad.push_back(-kEndless);
    for (const double value : setting.bad) {
      LiveSettings live;
      setting.of(live) = value;
      try {
        require_within_limits(live);
        ADD_FAILURE() << setting.option << " = " << value << " was accepted";
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Configuration);
        EXPECT_EQ(error.where(), setting.option);
      }
    }
    for (const double value : setting.good) {
      LiveSettings live;
      setting.of(live) = value;
      EXPECT_NO_THROW(require_within_limits(live)) << setting.option << " = " << value;
    }
  }
}

}  // namespace
}  // namespace palpate::app
