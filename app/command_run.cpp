// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/pipeline/device_profile.hpp"
#include "app/pipeline/workspace.hpp"
#include "app/play/shipped.hpp"
#include "app/record/relaxation_at_rate.hpp"
#include "app/record/report_recovery.hpp"
#include "app/record/session_recorder.hpp"
#include "app/run/certified.hpp"
#include "app/run/device_choice.hpp"
#include "app/run/device_options.hpp"
#include "app/run/force_clamp.hpp"
#include "app/run/limits.hpp"
#include "app/run/live_session.hpp"
#include "app/run/stop_on_interrupt.hpp"
#include "app/simulate/script.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

struct RunOptions {
  std::string library, profile, recording = "recording.h5";
  DeviceChoice device;
  LiveSettings live;
  std::vector<double> at_mm{0, 0, 0};
  std::optional<double> watchdog, max_force;
  double wake_early_us = 0;
  std::optional<double> tank_cap_mj;
  std::optional<double> friction;  ///< none: that of the certificate
  bool list = false, uncertified = false, strict = false;
};

/// A hand that presses and slides at the middle of the body, for the simulated device.
std::function<runtime::HandTarget(double)> scripted_hand(const Library& library,
                                                         const runtime::Pose& pose) {
  const auto path = std::make_shared<HandPath>(scripted_path(settled({}, library), library));
  return [path, pose](double time) {
    const HandState hand = path->at(time);
    return runtime::HandTarget{pose.to_world(hand.position), pose.turn(hand.velocity)};
  };
}

/// Without a profile, only the constants of the simulated device are known.
fitting::DeviceProfile profile_of(const RunOptions& options) {
  if (!options.profile.empty()) return read_device_profile(options.profile);
  fitting::DeviceProfile profile;
  profile.name = options.device.name;
  if (profile.name == kSimulatedDevice) {
    profile.damping = kPublishedDevice.damping;
    profile.coulomb_friction = kPublishedDevice.coulomb_friction;
    profile.delay = profile.position_resolution = profile.force_resolution = 0;
  }
  return profile;
}

void say_quantiles(const char* what, const runtime::LatencyHistogram& h) {
  say("  {}: median {:.1f} us, 99th percentile {:.1f}, 99.9th {:.1f}, largest {:.1f}", what,
      1e-3 * h.quantile(0.5), 1e-3 * h.quantile(0.99), 1e-3 * h.quantile(0.999),
      1e-3 * static_cast<double>(h.largest()));
}

void summarize(const LiveOutcome& outcome, const DepthWatch& depths, const std::string& file) {
  const runtime::LoopCounts& c = outcome.counts;
  if (!outcome.missing_rights.empty()) warn("missing permissions: " + outcome.missing_rights);
  say("run: {} steps -> {}", c.steps, file);
  say_quantiles("wake-up latency", c.wake);
  say_quantiles("step duration", c.compute);
  say("  steps that overran {} (periods missed {}), cut off {}, clamped {}, saturated {}, not "
      "recorded {}",
      c.overruns, c.missed, c.cut_off, c.clamped, c.saturated, c.unrecorded);
  say("  steps in contact {}, extrapolated beyond the computed depth {}", depths.contact(),
      depths.beyond());
  say("  samples: late {}, older than the watchdog allows {}, rejected {}", c.stale, c.outdated,
      c.rejected);
}

RecordingHeading heading_of(const RunOptions& options, const Library& library,
                            const std::string& device) {
  RecordingHeading heading;
  heading.device = device;
  heading.library_sha256 = sha256_of_file(options.library);
  heading.rate = options.live.loop.rate;
  heading.friction = options.live.contact.friction;
  heading.settings = session_settings(options.live);
  heading.provenance = library.provenance;
  heading.provenance.steps.push_back(
      make_provenance_step("run",
                           fmt::format("device = \"{}\"\nrate = {:g}\nuncertified = {}\n", device,
                                       options.live.loop.rate, options.uncertified),
                           {options.library}));
  return heading;
}

/// Before the summary: forces beyond the deepest sample are guesses.
void warn_of_depth(const DepthWatch& depths, const Library& library) {
  if (depths.beyond() == 0) return;
  warn(depths.warning(depth_of_responses(library),
                      "press less deep, or compute to a larger [indentation] depth"));
}

/// @throws Error when the session ended because of a fault.
void require_good_end(const LiveOutcome& outcome, const std::string& device,
                      const std::string& recording) {
  if (outcome.counts.silent) {
    throw Error(ErrorKind::Configuration, device, "the device sent no new sample for too long",
                "check its cable and restart its service; the recording is in " + recording);
  }
  if (outcome.counts.lost) {
    throw Error(ErrorKind::Configuration, device, "the device was disconnected",
                "check cable and power; the recording is in " + recording);
  }
  if (outcome.halted) {
    throw Error(ErrorKind::Internal, device, "the watchdog halted the device",
                "lower --rate or the load of the machine; the recording is in " + recording);
  }
}

/// @throws Error(Configuration) for a value out of range.
void enter_options(RunOptions& options) {
  LiveSettings& live = options.live;
  live.contact.friction = options.friction.value_or(0);
  for (std::size_t i = 0; i < 3; ++i) live.pose.position[i] = 1e-3 * options.at_mm[i];
  live.loop.wake_early = 1e-6 * options.wake_early_us;
  if (options.tank_cap_mj) live.contact.tank_cap = 1e-3 * *options.tank_cap_mj;
  if (options.watchdog) live.safety.watchdog = *options.watchdog;
  if (options.max_force) live.safety.max_force = *options.max_force;
  require_within_limits(live);
}

void settle(RunOptions& options, const Library& library, const palpate_library& body) {
  const fitting::DeviceProfile profile = profile_of(options);
  LiveSettings& live = options.live;
  if (!options.friction) live.contact.friction = library.certificate.friction;
  const auto reason =
      why_not_certified(library, options.library, profile, live.loop.rate, live.contact.friction);
  if (!options.uncertified) require_certified(reason);
  if (reason) warn(fmt::format("run: no guarantee: {}: {}", reason->where, reason->problem));
  live.contact.lipschitz_bound = lipschitz_bound_for(library, profile, live.loop.rate);
  if (live.contact.lipschitz_bound < body.lipschitz_bound) {
    say("run: the enforced Lipschitz bound is lowered to {} N/m, which is certified at this rate",
        number_text(live.contact.lipschitz_bound, 4));
  }
  if (!reason) {
    say("run: certified passive on {}, at {:g} Hz with a Lipschitz bound of {} N/m and mu = {:g}",
        profile.name, live.loop.rate, number_text(live.contact.lipschitz_bound, 4),
        live.contact.friction);
  }
  set_watchdog(live, options.watchdog);
  options.device.rate = live.loop.rate;
}

/// The driver states its force once the device is open.
void clamp_force(RunOptions& options, const runtime::Device& device) {
  const ForceClamp clamp = force_clamp(profile_of(options), options.max_force, device.peak_force());
  options.live.safety.max_force = clamp.max_force;
  if (clamp.origin.empty()) {
    warn("run: no largest force is known: give --max-force or a profile with continuous_force");
  } else {
    say("run: forces are clamped to {} N: {}", number_text(clamp.max_force, 4), clamp.origin);
  }
}

int run(RunOptions options) {
  if (options.list) return list_devices();
  if (options.library.empty()) {
    throw Error(ErrorKind::Configuration, "run", "no library was given",
                "name a library.h5, or list the devices with --list");
  }
  require_known_device(options.device.name);
  enter_options(options);
  options.library = chosen_library(options.library, shipped_folder()).string();
  const Library library = read_library(options.library);
  const palpate_library body(library);
  settle(options, library, body);
  if (const std::string text = short_relaxation_warning(library, options.live.loop.rate);
      !text.empty())
    warn(text);
  const auto device = make_device(options.device, scripted_hand(library, options.live.pose));
  recover_and_report(options.recording);
  device->open();
  clamp_force(options, *device);
  SessionRecorder recorder(options.recording, heading_of(options, library, device->name()));
  const StopOnInterrupt stop_on_interrupt;
  say("run: {} at {:g} Hz; end with Ctrl-C", options.device.name, options.live.loop.rate);
  const LiveOutcome outcome =
      run_live(*device, body, options.live, recorder, stop_on_interrupt.interrupted());
  if (outcome.not_recorded) throw_with_journal(*outcome.not_recorded, recorder.journal());
  recorder.finish();
  warn_of_depth(recorder.depths(), library);
  summarize(outcome, recorder.depths(), options.recording);
  require_good_end(outcome, device->name(), options.recording);
  return options.strict && recorder.depths().beyond() > 0 ? kExitIncomplete : kExitDone;
}

void add_device_options(CLI::App& command, RunOptions& o) {
  add_device_choice(command, o.device);
  command.add_flag("--list", o.list, "List the devices and exit");
  command.add_option("--profile", o.profile, "Device profile (TOML), see data/devices");
  command.add_flag("--uncertified", o.uncertified,
                   "Render although the device is not certified passive at this rate");
}

void add_loop_options(CLI::App& command, RunOptions& o) {
  command.add_option("--rate", o.live.loop.rate,
                     "Sampling rate of the force loop, Hz (default: 1000)");
  command.add_option("--duration", o.live.duration,
                     "s from the first step; 0, the default: until Ctrl-C");
  command.add_option("--friction", o.friction,
                     "Friction coefficient (default: that of the certificate)");
  command.add_option("--max-force", o.max_force,
                     "N, largest commanded force (default: the continuous, or else the peak force "
                     "of the profile)");
  command.add_option("--tank-cap-mJ", o.tank_cap_mj,
                     "mJ, cap of the energy tank, which lets a slide use what friction has taken; "
                     "0: none (default: 5)");
  command.add_option(
      "--max-speed", o.live.safety.max_speed,
      "m/s, speed of the device beyond which the force is switched off (default: 3)");
  command.add_option("--ramp", o.live.safety.ramp,
                     "s, duration of the force ramp at the start (default: 0.5)");
  command.add_option("--watchdog", o.watchdog,
                     "s without a step or a new sample until the force is cut off (default: 20 "
                     "periods of the loop)");
  command
      .add_option("--priority", o.live.loop.realtime.priority,
                  "SCHED_FIFO priority (default: 80); 0: ordinary scheduler")
      ->check(CLI::Range(0, 99));
  command.add_option("--core", o.live.loop.realtime.core, "CPU core of the force loop")
      ->check(CLI::Range(0, 4095));
  command.add_option("--wake-early-us", o.wake_early_us,
                     "us before a step is due at which the loop wakes, to read the clock until it "
                     "is due; 0, the default: it sleeps until then");
  command.add_option("--search-rate", o.live.search_rate,
                     "Rate of the search thread, Hz (default: 100); 0: none");
  command
      .add_option("--at-mm", o.at_mm,
                  "Position of the origin of the body in device coordinates: X Y Z")
      ->expected(3);
  command.add_option("--out", o.recording, "Recording (default: recording.h5)");
  command.add_flag("--strict", o.strict, kStrictSessionHelp);
}

}  // namespace

void add_run_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("run", "Render a response library on a device in real time");
  command->footer(
      "Example: palpate run out/cylinder/library.h5 --device force-dimension --profile my.toml");
  const auto options = std::make_shared<RunOptions>();
  command->add_option("LIBRARY", options->library,
                      "Name of a ready-made library, a library.h5, a .plib or a folder with one");
  add_device_options(*command, *options);
  add_loop_options(*command, *options);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace palpate::app
