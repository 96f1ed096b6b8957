// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/limits.hpp"

#include <fmt/format.h>

#include <limits>
#include <string>

#include "format/error.hpp"

namespace palpate::app {
namespace {

/// What an option of the command line may be; NaN is outside every range.
struct OptionRange {
  const char* name;
  const char* unit;
  double low, high;
  bool above = false;  ///< low itself is excluded
};

constexpr double kAnyForce = std::numeric_limits<double>::infinity();
constexpr OptionRange kRate{"--rate", "Hz", 1, 100000};
constexpr OptionRange kDuration{"--duration", "s", 0, 1e6};
constexpr OptionRange kFriction{"--friction", "", 0, 10};
constexpr OptionRange kTankCap{"--tank-cap-mJ", "mJ", 0, 1e9};
constexpr OptionRange kMaxForce{"--max-force", "N", 0, kAnyForce, true};
constexpr OptionRange kMaxSpeed{"--max-speed", "m/s", 0, 100, true};
constexpr OptionRange kRamp{"--ramp", "s", 0, 60};
constexpr OptionRange kWatchdog{"--watchdog", "s", 0, 60, true};
constexpr OptionRange kSearchRate{"--search-rate", "Hz", 0, 10000};
constexpr OptionRange kPosition{"--at-mm", "mm", -1e4, 1e4};

void require(const OptionRange& range, double value) {
  const bool from = range.above ? value > range.low : value >= range.low;
  if (from && value <= range.high) return;
  const std::string unit = *range.unit == '\0' ? "" : std::string(" ") + range.unit;
  refuse(
      range.name,
      fmt::format("{:g}{} is not {}{:g} {} {:g}{}", value, unit, range.above ? "above " : "from ",
                  range.low, range.above ? "and up to" : "to", range.high, unit),
      "give a value in this range, or leave it out; nothing was begun");
}

/// The range is that of the period. @pre the rate is within its limits
void require_wake_within(const runtime::LoopThreadSettings& loop) {
  const double most = 1e6 * runtime::LoopThreadSettings::kMostEarly / loop.rate;  // us
  require({"--wake-early-us", "us", 0, most}, 1e6 * loop.wake_early);
}

}  // namespace

void require_within_limits(const LiveSettings& live) {
  require(kRate, live.loop.rate);
  require_wake_within(live.loop);
  require(kDuration, live.duration);
  require(kFriction, live.contact.friction);
  require(kTankCap, 1e3 * live.contact.tank_cap);
  require(kMaxForce, live.safety.max_force);
  require(kMaxSpeed, live.safety.max_speed);
  require(kRamp, live.safety.ramp);
  require(kWatchdog, live.safety.watchdog);
  require(kSearchRate, live.search_rate);
  for (const double coordinate : live.pose.position) require(kPosition, 1e3 * coordinate);
}

}  // namespace palpate::app
