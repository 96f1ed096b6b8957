// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/simulate/session.hpp"
#include "format/error.hpp"
#include "runtime/palpate.h"

namespace palpate::app {
namespace {

std::int64_t steps_with(const Recording& recording, std::uint32_t bit) {
  return std::count_if(recording.steps.begin(), recording.steps.end(),
                       [bit](const RecordedStep& step) { return (step.status & bit) != 0; });
}

/// The latency that this share of the steps did not exceed, us.
double latency_quantile(const Recording& recording, double share) {
  std::vector<std::int64_t> latencies;
  for (const RecordedStep& step : recording.steps) latencies.push_back(step.latency_ns);
  const auto index =
      static_cast<std::ptrdiff_t>(std::floor(share * static_cast<double>(latencies.size() - 1)));
  std::nth_element(latencies.begin(), latencies.begin() + index, latencies.end());
  return static_cast<double>(latencies[static_cast<std::size_t>(index)]) * 1e-3;
}

void summarize(const Recording& recording, const std::filesystem::path& file) {
  double deepest = 0, largest = 0;
  for (const RecordedStep& step : recording.steps) {
    deepest = std::max(deepest, step.depth);
    largest = std::max(largest, norm(step.force));
  }
  say("simulate: {} steps at {} Hz, deepest {:.2f} mm, largest force {:.3f} N -> {}",
      recording.steps.size(), recording.rate, deepest * 1e3, largest, file.string());
  say("  contact in {} steps, sliding in {}, energy rule in {}, beyond the deepest sample in {}",
      steps_with(recording, PALPATE_CONTACT), steps_with(recording, PALPATE_SLIDING),
      steps_with(recording, PALPATE_ENERGY_LIMITED), steps_with(recording, PALPATE_BEYOND_DEPTH));
  say("  absorbed by the body: {:.3f} mJ; force step: median {:.2f} us, 99 % within {:.2f} us",
      recording.steps.back().absorbed * 1e3, latency_quantile(recording, 0.5),
      latency_quantile(recording, 0.99));
}

int simulate(const CaseOptions& options, const std::string& library_option) {
  const Workspace space = open_workspace(options);
  const std::filesystem::path file =
      library_option.empty() ? space.library() : std::filesystem::path(library_option);
  if (!std::filesystem::exists(file)) {
    throw Error(ErrorKind::Configuration, file.string(), "the file does not exist",
                "make it with `palpate build`");
  }
  const Library library = read_library(file);
  prepare_output(space.out);
  Recording recording = play_session(file, library, space.c.simulate);
  recording.provenance = library.provenance;
  recording.provenance.steps.push_back(
      make_provenance_step("simulate", resolved_toml(space.c), {file}));
  write_recording(space.recording(), recording);
  summarize(recording, space.recording());
  return kExitDone;
}

}  // namespace

void add_simulate_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "simulate", "Press, slide and release on library.h5 with a simulated device -> recording.h5");
  command->footer("Example: palpate simulate data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_case_options(*command);
  const auto library = std::make_shared<std::string>();
  command->add_option("--library", *library, "Response library (default: library.h5 of the case)");
  command->callback([options, library, &action] {
    action = [options, library] { return simulate(*options, *library); };
  });
}

}  // namespace palpate::app
