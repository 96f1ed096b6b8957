// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <sstream>

#include "app/case_options.hpp"
#include "app/command.hpp"
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
  };
  const auto common = add_case_options(*command, ThreadsOption::Present);
  const auto options = std::make_shared<Options>();
  command->add_option(
      "--shard", options->shard,
      "I/N: only the I-th of N parts of the sites, into curves.I-of-N.h5; see merge");
  command->add_flag("--json", options->json, "Tell each event as a JSON object on a line");
  command->callback([common, options, &action] {
    action = [common, options] {
      Workspace space = open_workspace(*common);
      if (!options->shard.empty()) space.shard = parse_shard(options->shard);
      const SiteCounts counts =
          run_precompute(space, options->json ? Telling::Json : Telling::Text);
      return counts.all_complete() ? kExitDone : kExitSomeSitesFailed;
    };
  });
}

}  // namespace palpate::app
