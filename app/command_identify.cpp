// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/case/case.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/identify/device_findings.hpp"
#include "app/identify/excitation_loop.hpp"
#include "app/run/device_options.hpp"
#include "app/run/stop_on_interrupt.hpp"
#include "fitting/measurement/identify/directions.hpp"
#include "fitting/measurement/identify/estimate.hpp"
#include "format/crash_safe_file.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/provenance.hpp"
#include "runtime/devices/device_virtual.hpp"
#include "runtime/loop_thread.hpp"

namespace palpate::app {
namespace {

struct IdentifyOptions {
  DeviceChoice device;
  std::string axes = "xyz", name, out = "device.toml";
  double rate = 1000;    // Hz
  double max_force = 1;  // N
  double box_mm = 20;
  double max_speed = 0.7;  // m/s
  double seconds = 15;     // along each direction
  double largest_delay_ms = 30;
  std::optional<double> force_resolution_mn, watchdog;
  bool list = false;
};

void require_in_range(const char* option, double value, double low, double high) {
  if (value >= low && value <= high) return;
  refuse(option, fmt::format("{:g} is out of range", value),
         fmt::format("give {:g} to {:g}", low, high));
}

/// Before the device is opened.
void require_valid(const IdentifyOptions& o) {
  require_known_device(o.device.name);
  require_in_range("--rate", o.rate, 100, 20000);
  require_in_range("--max-force", o.max_force, 1e-3, 20);
  require_in_range("--box-mm", o.box_mm, 1, 200);
  require_in_range("--max-speed", o.max_speed, 0.01, 3);
  require_in_range("--seconds", o.seconds, 3, 120);
  require_in_range("--largest-delay-ms", o.largest_delay_ms, 1, 100);
  if (o.watchdog) require_in_range("--watchdog", *o.watchdog, 1e-3, 60);
  if (o.force_resolution_mn)
    require_in_range("--force-resolution-mN", *o.force_resolution_mn, 0, 1e4);
  std::string once = o.axes;
  std::sort(once.begin(), once.end());
  const bool good = !once.empty() && once.find_first_not_of("xyz") == std::string::npos &&
                    std::adjacent_find(once.begin(), once.end()) == once.end();
  if (!good) refuse("--axes", "'" + o.axes + "' does not name axes once each", "give some of xyz");
  if (std::filesystem::exists(o.out))
    refuse(o.out, "it exists", "remove it, or name another file with --out");
}

/// The simulated device hangs free here: a hand would add its own damping.
std::unique_ptr<runtime::Device> device_of(const IdentifyOptions& options) {
  if (options.device.name != kSimulatedDevice) return make_device(options.device, {});
  runtime::SimulatedDeviceSettings settings = kPublishedDevice;
  settings.hand_stiffness = settings.hand_damping = 0;
  return std::make_unique<runtime::VirtualDevice>(settings, options.rate,
                                                  [](double) { return runtime::HandTarget{}; });
}

double watchdog_of(const IdentifyOptions& o) {
  return o.watchdog.value_or(runtime::default_watchdog(o.rate));
}

ExcitationLoopSettings loop_settings(const IdentifyOptions& o, const Vec3& direction) {
  ExcitationLoopSettings s;
  s.excitation = {direction, o.max_force, 1e-3 * o.box_mm, o.seconds};
  s.safety.max_force = o.max_force;
  s.safety.max_speed = o.max_speed;
  s.safety.period = 1 / o.rate;
  s.safety.watchdog = watchdog_of(o);
  s.rate = o.rate;
  s.counted_time = o.device.name == kSimulatedDevice;
  return s;
}

/// @throws Error where the motion ended before its time.
void require_complete(const IdentifyOptions& o, ExcitationEnd end, bool halted,
                      const Vec3& direction) {
  const std::string where = o.device.name + ", along " + identify::direction_name(direction);
  const auto fail = [&where](const std::string& problem, const std::string& remedy) {
    refuse(where, problem, remedy);
  };
  if (halted)
    fail(fmt::format("no step began for {:g} ms, so that the device was halted",
                     1e3 * watchdog_of(o)),
         "close other programs, or lower --rate");
  switch (end) {
    case ExcitationEnd::LeftBox:
      fail(fmt::format("the tip left the box of {:g} mm around its start", o.box_mm),
           "turn the gravity compensation of the device on, hold the weight, lower --max-force, or "
           "raise --box-mm");
      break;
    case ExcitationEnd::TooFast:
      fail(fmt::format("the tip was faster than {:g} m/s", o.max_speed),
           "lower --max-force, or raise --max-speed");
      break;
    case ExcitationEnd::Saturated:
      fail(fmt::format("the device gave less than the {:g} N that were commanded", o.max_force),
           "lower --max-force");
      break;
    case ExcitationEnd::Lost:
      fail("the device was disconnected", "check cable and power");
      break;
    case ExcitationEnd::Silent:
      fail("the device sent no new sample for too long", "check its cable and restart its service");
      break;
    case ExcitationEnd::Running:
      refuse("identify", "it was interrupted; nothing was written", "run it again");
    case ExcitationEnd::Done:
      break;
  }
}

/// Runs an excitation until it ends or is interrupted: at its rate, or at once where the time of
/// the device is counted. True where the watchdog halted the device.
bool excite(const IdentifyOptions& o, runtime::Device& device, ExcitationLoop& loop,
            const StopOnInterrupt& stop) {
  if (o.device.name == kSimulatedDevice) {
    while (!stop.interrupted() && loop.tick(0)) continue;
    return false;
  }
  runtime::LoopThread thread(loop, device, {o.rate, watchdog_of(o), {}, 0});
  while (thread.running() && !thread.halted() && !stop.interrupted())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  thread.stop();
  return thread.halted();
}

DirectionFinding measure(const IdentifyOptions& o, runtime::Device& device, const Vec3& direction,
                         const StopOnInterrupt& stop) {
  answer("identify: {}: {:g} s with up to {:g} N; keep the hand off the handle",
         identify::direction_name(direction), o.seconds, o.max_force);
  ExcitationLoop loop(device, loop_settings(o, direction));
  const bool halted = excite(o, device, loop, stop);
  require_complete(o, loop.end(), halted, direction);
  say("  longest period of the loop {:.3f} ms", 1e3 * loop.longest_period());
  if (loop.missed() > 0)
    say("  {} missed", count_text(loop.missed(), "period was", "periods were"));
  if (loop.stale() > 0) say("  {} had no new sample", count_text(loop.stale(), "step"));
  return {direction, identify::estimate_axis(loop.record(), 1e-3 * o.largest_delay_ms),
          identify::position_step(loop.record()),
          std::max(0.0, loop.longest_period() - 1 / o.rate)};
}

void say_direction(const DirectionFinding& found) {
  const identify::AxisEstimate& e = found.estimate;
  if (!e.problem.empty()) {
    warn(
        fmt::format("identify: along {} {}", identify::direction_name(found.direction), e.problem));
    return;
  }
  say("  travel {:.1f} mm, misfit {:.2g} N, steps of the position at most {:.3g} um",
      1e3 * e.travel, e.residual, 1e6 * found.position_step);
  say("  {}", direction_line(found));
}

std::vector<Vec3> directions_of(const IdentifyOptions& o) {
  std::vector<std::size_t> axes;
  for (const char letter : o.axes) axes.push_back(static_cast<std::size_t>(letter - 'x'));
  return identify::directions_between(axes);
}

DeviceFindings findings_of(const IdentifyOptions& o, const std::string& device,
                           const std::vector<DirectionFinding>& found) {
  DeviceFindings findings = combine(found);
  findings.profile.name = o.name.empty() ? device : o.name;
  findings.profile.source = fmt::format(
      "palpate identify of {}, {}, at {:g} Hz, {:g} s and {:g} N along {}", device,
      make_provenance_step("identify", "", {}).utc, o.rate, o.seconds, o.max_force, o.axes);
  if (o.force_resolution_mn) {
    findings.profile.force_resolution = 1e-3 * *o.force_resolution_mn;
    findings.profile.source += "; force_resolution: as given";
  } else {
    findings.missing.push_back({"force resolution",
                                "it cannot be measured; give that of the manual "
                                "with --force-resolution-mN"});
  }
  return findings;
}

int identify_device(const IdentifyOptions& options) {
  if (options.list) return list_devices();
  require_valid(options);
  const auto device = device_of(options);
  device->open();
  const std::string name = device->name();
  std::vector<DirectionFinding> found;
  {
    const StopOnInterrupt stop;
    for (const Vec3& direction : directions_of(options)) {
      found.push_back(measure(options, *device, direction, stop));
      say_direction(found.back());
    }
  }
  device->close();
  const DeviceFindings findings = findings_of(options, name, found);
  if (options.axes.size() < 3)
    warn("identify: the profile is that of a device that moves along " + options.axes + " only");
  for (const Missing& m : findings.missing)
    warn(fmt::format("identify: {} is left out: {}", m.constant, m.reason));
  write_file_crash_safely(options.out, profile_text(findings, found));
  say("identify: {}", options.out);
  return findings.missing.empty() ? kExitDone : kExitIncomplete;
}

}  // namespace

void add_identify_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "identify", "Measure damping, friction, delay and resolution of a device: its profile");
  command->footer(
      "Example: palpate identify --device force-dimension --force-resolution-mN 2 --out my.toml");
  const auto o = std::make_shared<IdentifyOptions>();
  add_device_choice(*command, o->device);
  command->add_flag("--list", o->list, "List the devices and exit");
  command->add_option(
      "--axes", o->axes,
      "Axes to measure, with the diagonals between them, for a device that lacks some (xyz)");
  command->add_option("--rate", o->rate, "Sampling rate of the force loop, Hz (1000)");
  command->add_option("--max-force", o->max_force, "N, largest component of the force (1)");
  command->add_option("--box-mm", o->box_mm,
                      "Distance from the start beyond which the force is switched off (20)");
  command->add_option("--max-speed", o->max_speed,
                      "m/s, speed beyond which the force is switched off (0.7)");
  command->add_option("--watchdog", o->watchdog,
                      "s without a step or a new sample until the force is cut off (20 periods)");
  command->add_option("--seconds", o->seconds, "Duration along each of up to 13 directions (15)");
  command->add_option("--largest-delay-ms", o->largest_delay_ms,
                      "Delays are searched up to this one (30)");
  command->add_option("--force-resolution-mN", o->force_resolution_mn,
                      "Step of the force along an axis, of the manual: it cannot be measured");
  command->add_option("--name", o->name, "Name in the profile (default: that of the device)");
  command->add_option("--out", o->out, "Profile to write (default: device.toml)");
  command->callback([o, &action] { action = [o] { return identify_device(*o); }; });
}

}  // namespace palpate::app
