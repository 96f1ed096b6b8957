// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/record/relaxation_at_rate.hpp"
#include "app/record/report_recovery.hpp"
#include "app/simulate/script.hpp"
#include "app/simulate/session.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "runtime/latency_histogram.hpp"
#include "runtime/palpate.h"

namespace palpate::app {
namespace {

/// Statistics of a session, updated after each step.
struct Summary {
  std::int64_t steps = 0, sliding = 0, rate_limited = 0, limited = 0;
  double largest = 0, absorbed = 0;
  runtime::LatencyHistogram latency;

  void see(const RecordedStep& step) {
    const auto one_if = [&](std::uint32_t bit) { return (step.status & bit) != 0 ? 1 : 0; };
    ++steps;
    sliding += one_if(PALPATE_SLIDING);
    rate_limited += one_if(PALPATE_FORCE_LIMITED);
    limited += one_if(PALPATE_ENERGY_LIMITED);
    largest = std::max(largest, norm(step.force));
    absorbed = step.absorbed;
    latency.add(step.latency_ns);
  }
};

void print(const Summary& s, const DepthWatch& depths, double rate,
           const std::filesystem::path& file) {
  say("simulate: {} steps at {} Hz, deepest {}, largest force {} -> {}", s.steps, rate,
      length_text(depths.deepest()), force_text(s.largest), file.string());
  say("  steps in contact {}, sliding {}, rate-limited {}, limited by the energy rule {}, "
      "extrapolated beyond the computed depth {}",
      depths.contact(), s.sliding, s.rate_limited, s.limited, depths.beyond());
  say("  absorbed by the body: {}; force step: median {:.2f} us, 99 % within {:.2f} us",
      energy_text(s.absorbed), s.latency.quantile(0.5) * 1e-3, s.latency.quantile(0.99) * 1e-3);
}

struct SimulateOptions {
  std::string library;
  double lipschitz_bound = 0;  ///< N/m; 0: that of the library
  bool strict = false;
};

int simulate(const CaseOptions& options, const SimulateOptions& session_options) {
  Workspace space = open_workspace(options);
  const std::filesystem::path file = session_options.library.empty()
                                         ? space.library()
                                         : std::filesystem::path(session_options.library);
  if (!std::filesystem::exists(file)) {
    throw Error(ErrorKind::Configuration, file.string(), "the file does not exist",
                "make it with `palpate build`");
  }
  const Library library = read_library(file);
  prepare_output(space.out);
  recover_and_report(space.recording());
  space.c.simulate = settled(space.c.simulate, library);
  if (const std::string text = short_relaxation_warning(library, space.c.simulate.rate);
      !text.empty())
    warn(text);
  ScriptedSession session(file, library, space.c.simulate, session_options.lipschitz_bound);
  RecordingHeading heading = session.heading();
  heading.provenance = library.provenance;
  heading.provenance.steps.push_back(
      make_provenance_step("simulate", resolved_toml(space.c), {file}));
  SessionRecorder recorder(space.recording(), heading);
  Summary summary;
  try {
    session.play([&](const RecordedStep& step) {
      summary.see(step);
      recorder.add(step);
    });
  } catch (const Error& error) {
    throw_with_journal(error, recorder.journal());
  }
  recorder.finish();
  const DepthWatch& depths = recorder.depths();
  // Before anything else: forces beyond the deepest sample are guesses.
  if (depths.beyond() > 0)
    warn(depths.warning(depth_of_responses(library),
                        "give a smaller [simulate] press_depth, or compute to a larger "
                        "[indentation] depth"));
  print(summary, depths, heading.rate, space.recording());
  return session_options.strict && depths.beyond() > 0 ? kExitIncomplete : kExitDone;
}

}  // namespace

void add_simulate_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "simulate",
      "Scripted press, slide and release on library.h5 with a simulated device -> recording.h5");
  command->footer("Example: palpate simulate data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_case_options(*command);
  const auto session = std::make_shared<SimulateOptions>();
  command->add_option("--library", session->library,
                      "Response library (default: library.h5 of the case)");
  command
      ->add_option(
          "--lipschitz-bound", session->lipschitz_bound,
          "N/m: Lipschitz bound of the force that the runtime enforces, at least the L_min "
          "of the library (default: that of the library)")
      ->check(CLI::PositiveNumber);
  command->add_flag("--strict", session->strict, kStrictSessionHelp);
  command->callback([options, session, &action] {
    action = [options, session] { return simulate(*options, *session); };
  });
}

}  // namespace palpate::app
