// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/experiment/energy_balance.hpp"
#include "app/experiment/phase_plane.hpp"
#include "app/experiment/slingshot.hpp"
#include "app/pipeline/workspace.hpp"

namespace palpate::app {
namespace {

constexpr double kPublishedBelow = 168, kPublishedAbove = 179;  // N/m, figure 12

struct ExperimentOptions {
  std::string out = "out/experiment";
  double tolerance = 0.5;  // N/m
  bool margins = false;
};

void draw_figure_12(const std::filesystem::path& out) {
  std::vector<PhasePlane> planes;
  for (const double k : {kPublishedBelow, kPublishedAbove}) {
    const SlingshotOutcome o = sling({}, k, true);
    say("  k = {:g} N/m: impact at {:.3f} m/s, {} after {:.1f} s, amplitude {:.3f} m/s", k,
        o.impact, o.decayed ? "at rest" : "sustained oscillation", o.seconds, o.amplitude);
    write_phase_csv(out / fmt::format("phase_plane_{:g}.csv", k), o.path);
    const std::string end = o.decayed ? fmt::format("at rest after {:.0f} s", o.seconds)
                                      : fmt::format("oscillates with {:.3f} m/s", o.amplitude);
    planes.push_back({fmt::format("k = {:g} N/m: {}", k, end), o.path});
  }
  write_phase_planes(out / "phase_planes.svg", planes);
}

void wall_margins(double tolerance) {
  say("wall: smallest stiffness with sustained oscillation, N/m");
  say("  {:>8} {:>10} {:>16}", "rate", "simulated", "energy balance");
  for (const double rate : {1000.0, 2000.0, 4000.0}) {
    SlingshotSetup setup;
    setup.rate = rate;
    say("  {:>5g} Hz {:>10.1f} {:>16.1f}", rate, passivity_margin(setup, 20, 800, tolerance),
        bonded_margin_by_energy_balance(rate, 0));
  }
}

void cylinder_margins(double tolerance) {
  say("cylinder, 2000 Hz: the same, with the search in the force loop and at 100 Hz");
  say("  {:>8} {:>5} {:>10} {:>10} {:>16}", "off axis", "mu", "one rate", "two rates",
      "energy balance");
  struct Line {
    double off_axis, friction;
  };
  for (const auto& [off_axis, friction] :
       {Line{0, 0.3}, Line{0.01, 0.3}, Line{0.01, 0.1}, Line{0.01, 0.0}}) {
    SlingshotSetup one{VirtualBody::Cylinder, off_axis, friction, 2000, 0};
    SlingshotSetup two = one;
    two.search_rate = 100;
    say("  {:>5g} mm {:>5g} {:>10.1f} {:>10.1f} {:>16.1f}", 1e3 * off_axis, friction,
        passivity_margin(one, 100, 600, tolerance), passivity_margin(two, 100, 600, tolerance),
        margin_by_played_swings(one));
  }
  constexpr double kOffAxis = 0.01, kRadius = 0.04;  // m
  say("  {:>5g} mm bonded, closed form {:>27.1f}", 1e3 * kOffAxis,
      bonded_margin_by_energy_balance(2000, std::asin(kOffAxis / kRadius)));
}

int experiment(const ExperimentOptions& options) {
  prepare_output(options.out);
  say("experiment: a device hits a virtual wall [Mahvash & Hayward 2005, section VI-B], simulated");
  draw_figure_12(options.out);
  if (options.margins) {
    wall_margins(options.tolerance);
    cylinder_margins(options.tolerance);
  }
  say("  -> {}", (std::filesystem::path(options.out) / "phase_planes.svg").string());
  return kExitDone;
}

}  // namespace

void add_experiment_command(CLI::App& root, Action& action) {
  CLI::App* parent =
      root.add_subcommand("experiment", "Repeats a published experiment in simulation");
  parent->require_subcommand(1);
  CLI::App* command = parent->add_subcommand(
      "passivity", "A device hits a virtual body: phase planes and passivity margins");
  command->footer("Example: palpate experiment passivity --margins");
  const auto options = std::make_shared<ExperimentOptions>();
  command->add_option("--out", options->out, "Folder of the figures (default: out/experiment)");
  command->add_flag("--margins", options->margins,
                    "Also compute the passivity margins of wall and cylinder (about a minute)");
  command
      ->add_option("--tolerance", options->tolerance,
                   "Tolerance of the margins, N/m (default: 0.5)")
      ->check(CLI::Range(0.01, 10.0));
  command->callback([options, &action] { action = [options] { return experiment(*options); }; });
}

}  // namespace palpate::app
