// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/experiment/energy_balance.hpp"
#include "app/experiment/phase_plane.hpp"
#include "app/experiment/sling_device.hpp"
#include "app/experiment/slingshot.hpp"
#include "app/experiment/touch_picture.hpp"
#include "app/pipeline/workspace.hpp"

namespace palpate::app {
namespace {

struct ExperimentOptions {
  std::string out = "out/experiment";
  double tolerance = 0.5;  // N/m
  bool margins = false;
  bool choices = false;
  bool real_time = false;
};

constexpr double kOffAxis = 0.01;  // m

SlingshotSetup on_cylinder(double off_axis, double friction) {
  return {VirtualBody::Cylinder, off_axis, friction, published::kRate, 0};
}

/// The lines of motion of the tables.
const std::array<SlingshotSetup, 4> kLines{on_cylinder(0, 0.3), on_cylinder(kOffAxis, 0.3),
                                           on_cylinder(kOffAxis, 0.1), on_cylinder(kOffAxis, 0)};

/// Which constants are published, which are fitted to what, and which are a choice.
void list_constants() {
  const SlingDevice device;
  answer(
      "  published: released {:g} mm outside, impact at {:g} m/s, about {:g} N at rest, {:g} Hz, "
      "passive up to {:g} N/m",
      -1e3 * published::kRelease, published::kImpact, published::kRestForce, published::kRate,
      published::kMargin);
  answer(
      "  fitted to these on the wall: mass {:g} kg (impact), damping {:g} N s/m (passive up to), "
      "anchor of the band {:g} mm (force at rest)",
      device.mass, device.damping, 1e3 * device.anchor);
  answer(
      "  chosen, because neither published nor determined: band {:g} N/m, dry friction {:g} N, "
      "radius 40 mm of the cylinder, (35) as its lateral response",
      device.band, device.friction);
}

void draw_figure_12(const std::filesystem::path& out) {
  std::vector<PhasePlane> planes;
  for (const double k : {published::kAtRest, published::kOscillating}) {
    const SlingshotOutcome o = sling({}, k, true);
    answer("  k = {:g} N/m: impact at {:.3f} m/s, {} after {:.1f} s, amplitude {:.3f} m/s", k,
           o.impact, o.decayed ? "at rest" : "sustained oscillation", o.seconds, o.amplitude);
    write_phase_csv(out / fmt::format("phase_plane_{:g}.csv", k), o.path);
    const std::string end = o.decayed ? fmt::format("at rest after {:.0f} s", o.seconds)
                                      : fmt::format("oscillates with {:.3f} m/s", o.amplitude);
    planes.push_back({fmt::format("k = {:g} N/m: {}", k, end), o.path});
  }
  write_phase_planes(out / "phase_planes.svg", planes);
}

void draw_figure_11(const std::filesystem::path& out) {
  constexpr double kDepth = 0.008;  // m
  write_touch_picture(out / "touch.svg", kLines[1], published::kMargin, kDepth);
}

void wall_margins(double tolerance) {
  answer("wall: smallest stiffness with sustained oscillation, N/m");
  answer("  {:>8} {:>10} {:>16}", "rate", "simulated", "energy balance");
  for (const double rate : {1000.0, 2000.0, 4000.0}) {
    SlingshotSetup setup;
    setup.rate = rate;
    answer("  {:>5g} Hz {:>10.1f} {:>16.1f}", rate, passivity_margin(setup, 20, 800, tolerance),
           bonded_margin_by_energy_balance(setup.device, rate, 0));
  }
}

SlingshotSetup with_two_rates(SlingshotSetup setup) {
  setup.search_rate = published::kSearchRate;
  return setup;
}

/// In closed form: friction fixes the contact point.
double no_slip_margin_off_axis(const SlingDevice& device) {
  constexpr double kRadius = 0.04;  // m
  return bonded_margin_by_energy_balance(device, published::kRate, std::asin(kOffAxis / kRadius));
}

void cylinder_margins(double tolerance) {
  answer(
      "cylinder, {:g} Hz: the same, with the search in the force loop and at {:g} Hz, and with a "
      "Lipschitz bound of k enforced",
      published::kRate, published::kSearchRate);
  answer("  {:>8} {:>5} {:>10} {:>10} {:>10} {:>16}", "off axis", "mu", "one rate", "two rates",
         "bounded", "energy balance");
  for (const SlingshotSetup& one : kLines) {
    SlingshotSetup bounded = one;
    bounded.bounded = true;
    const auto margin = [tolerance](const SlingshotSetup& setup) {
      return passivity_margin(setup, 100, 600, tolerance);
    };
    answer("  {:>5g} mm {:>5g} {:>10.1f} {:>10.1f} {:>10.1f} {:>16.1f}", 1e3 * one.off_axis,
           one.friction, margin(one), margin(with_two_rates(one)), margin(bounded),
           margin_by_played_swings(one));
  }
  answer("  {:>5g} mm no-slip, closed form {:>38.1f}", 1e3 * kOffAxis, no_slip_margin_off_axis({}));
}

/// Does the agreement of wall and cylinder depend on what the paper does not determine?
void other_choices(double tolerance) {
  answer("other bands and dry frictions, mass, anchor and damping fitted again: margins, N/m");
  answer("  {:>8} {:>6} {:>8} {:>12} {:>6} {:>8} {:>10} {:>16}", "band N/m", "dry N", "mass kg",
         "damping Ns/m", "wall", "on axis", "10 mm off", "energy balance");
  for (const auto& [band, friction] : {std::pair{10.0, 0.01}, std::pair{20.0, 0.0},
                                       std::pair{20.0, 0.03}, std::pair{40.0, 0.01}}) {
    SlingshotSetup wall, on_axis = kLines[0], off_axis = kLines[1];
    wall.device = on_axis.device = off_axis.device = fitted_device(band, friction);
    const auto margin = [tolerance](const SlingshotSetup& setup) {
      return passivity_margin(setup, 100, 300, tolerance);
    };
    answer("  {:>8g} {:>6g} {:>8.4f} {:>12.4f} {:>6.1f} {:>8.1f} {:>10.1f} {:>16.1f}", band,
           friction, wall.device.mass, wall.device.damping, margin(wall), margin(on_axis),
           margin(off_axis), no_slip_margin_off_axis(wall.device));
  }
}

/// The cylinder with the search in a thread of its own: 3 % below and above the margin of the
/// simulation in lockstep.
void shots_in_real_time(double tolerance) {
  answer("cylinder in real time, the search in a thread of its own at {:g} Hz",
         published::kSearchRate);
  for (const SlingshotSetup& line : kLines) {
    SlingshotSetup setup = with_two_rates(line);
    const double margin = passivity_margin(setup, 100, 600, tolerance);
    setup.real_time = true;
    for (const double k : {0.97 * margin, 1.03 * margin}) {
      const SlingshotOutcome o = sling(setup, k);
      answer(
          "  {:g} mm off, mu = {:g}, k = {:.1f} N/m ({:+.0f} % of the margin): {} after {:.0f} s, "
          "{} of {} steps late",
          1e3 * line.off_axis, line.friction, k, 100 * (k / margin - 1),
          o.decayed ? "at rest" : "sustained oscillation", o.seconds, o.late, o.steps);
    }
  }
}

int experiment(const ExperimentOptions& options) {
  prepare_output(options.out);
  answer(
      "experiment: a device hits a virtual wall [Mahvash & Hayward 2005, section VI-B], simulated");
  list_constants();
  draw_figure_12(options.out);
  draw_figure_11(options.out);
  if (options.margins) {
    wall_margins(options.tolerance);
    cylinder_margins(options.tolerance);
  }
  if (options.choices) other_choices(options.tolerance);
  if (options.real_time) shots_in_real_time(options.tolerance);
  for (const char* picture : {"phase_planes.svg", "touch.svg"})
    say("  -> {}", (std::filesystem::path(options.out) / picture).string());
  return kExitDone;
}

}  // namespace

void add_experiment_command(CLI::App& root, Action& action) {
  CLI::App* parent =
      root.add_subcommand("experiment", "Repeats a published experiment in simulation");
  parent->footer("Example: palpate experiment passivity --margins");
  parent->require_subcommand(1);
  CLI::App* command = parent->add_subcommand(
      "passivity", "A device hits a virtual body: phase planes and passivity margins");
  command->footer("Example: palpate experiment passivity --margins");
  const auto options = std::make_shared<ExperimentOptions>();
  command->add_option("--out", options->out, "Folder of the figures (default: out/experiment)");
  command->add_flag("--margins", options->margins,
                    "Also compute the passivity margins of wall and cylinder (about two minutes)");
  command->add_flag("--choices", options->choices,
                    "Also compute them for other values of what the paper does not determine");
  command->add_flag("--real-time", options->real_time,
                    "Also shoot below and above each margin of the cylinder in real time, with the "
                    "search in a thread (about ten minutes)");
  command
      ->add_option("--tolerance", options->tolerance,
                   "Tolerance of the margins, N/m (default: 0.5)")
      ->check(CLI::Range(0.01, 10.0));
  command->callback([options, &action] { action = [options] { return experiment(*options); }; });
}

}  // namespace palpate::app
