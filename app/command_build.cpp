// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"

namespace palpate::app {

void add_build_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "build", "The whole way from the case to library.h5, skipping what is up to date");
  command->footer("Example: palpate build data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_case_options(*command, ThreadsOption::Present);
  command->callback([options, &action] {
    action = [options] {
      const SiteCounts counts = run_build(open_workspace(*options));
      return counts.all_complete() ? kExitDone : kExitSomeSitesFailed;
    };
  });
}

}  // namespace palpate::app
