// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <cstdint>
#include <sstream>
#include <vector>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/convergence.hpp"
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
    throw Error(ErrorKind::Configuration, "--shard " + text, "is no part I/N with 1 <= I <= N",
                "for the second of four parts write --shard 2/4");
  return shard;
}

}  // namespace

void add_precompute_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "precompute", "body.h5 -> curves.h5: press and drag the tool at every site");
  command->footer("Example: palpate precompute data/cases/cylinder.toml --out out/cylinder");
  struct Options {
    std::string shard;
    bool json = false;
    int convergence = 0;
    std::vector<std::int32_t> sites;
  };
  const auto common = add_case_options(*command, ThreadsOption::Present);
  const auto options = std::make_shared<Options>();
  command->add_option(
      "--shard", options->shard,
      "I/N: only the I-th of N parts of the sites, into curves.I-of-N.h5; see merge");
  command->add_flag("--json", options->json, "Tell each event as a JSON object on a line");
  command->add_option(
      "--convergence", options->convergence,
      "N: instead, press some sites on N ever finer meshes, the case's first; see convergence.csv");
  command->add_option("--sites", options->sites, "Sites of --convergence; by default three")
      ->delimiter(',');
  command->callback([common, options, &action] {
    action = [common, options] {
      Workspace space = open_workspace(*common);
      if (options->convergence != 0) {
        run_convergence(space, options->convergence, options->sites);
        return kExitDone;
      }
      if (!options->shard.empty()) space.shard = parse_shard(options->shard);
      const SiteCounts counts =
          run_precompute(space, options->json ? Telling::Json : Telling::Text);
      return counts.all_complete() ? kExitDone : kExitSomeSitesFailed;
    };
  });
}

}  // namespace palpate::app
