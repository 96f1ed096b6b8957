// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <cstdint>
#include <sstream>
#include <vector>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/convergence.hpp"
#include "app/pipeline/estimate.hpp"
#include "app/pipeline/stages.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

Shard parse_shard(const std::string& text) {
  Shard shard;
  char slash = 0, more = 0;
  std::istringstream in(text);
  const bool is_pair = static_cast<bool>(in >> shard.index >> slash >> shard.count);
  if (!is_pair || slash != '/' || in >> more || shard.index < 1 || shard.index > shard.count)
    throw Error(ErrorKind::Configuration, "--shard " + text, "it is not I/N with 1 <= I <= N",
                "for the second of four parts write --shard 2/4");
  return shard;
}

}  // namespace

void add_precompute_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "precompute", "body.h5 -> curves.h5: indentation and lateral paths at every site");
  command->footer("Example: palpate precompute data/cases/cylinder.toml --out out/cylinder");
  struct Options {
    std::string shard;
    int convergence = 0;
    bool strict = false, estimate = false;
    std::vector<std::int32_t> sites;
  };
  const auto common = add_stage_options(*command, ThreadsOption::Present);
  const auto options = std::make_shared<Options>();
  command->add_option(
      "--shard", options->shard,
      "I/N: compute only the I-th of N parts of the sites and write curves.I-of-N.h5; see merge");
  CLI::Option* convergence = command->add_option(
      "--convergence", options->convergence,
      "N: instead, press some sites on N meshes, that of the case and finer ones, "
      "and extrapolate the "
      "forces; writes convergence.csv");
  command->add_option("--sites", options->sites, "Sites of --convergence (default: three)")
      ->delimiter(',')
      ->needs(convergence);
  command->add_flag("--strict", options->strict, kStrictHelp);
  command->add_flag("--estimate", options->estimate, kEstimateHelp);
  command->callback([common, options, &action] {
    action = [common, options] {
      Workspace space = open_workspace(*common);
      if (options->convergence != 0) {
        run_convergence(space, options->convergence, options->sites, event_sink(*common));
        return kExitDone;
      }
      if (!options->shard.empty()) space.shard = parse_shard(options->shard);
      if (options->estimate) {
        estimate_precompute(space, event_sink(*common));
        return kExitDone;
      }
      const SiteCounts counts = run_precompute(space, event_sink(*common));
      return exit_code_of(counts, options->strict);
    };
  });
}

}  // namespace palpate::app
