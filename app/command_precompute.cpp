// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"

namespace palpate::app {

void add_precompute_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "precompute", "body.h5 -> curves.h5: press and drag the tool at every site");
  command->footer("Example: palpate precompute data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_case_options(*command, ThreadsOption::Present);
  command->callback([options, &action] {
    action = [options] {
      const SiteCounts counts = run_precompute(open_workspace(*options));
      return counts.all_complete() ? kExitDone : kExitSomeSitesFailed;
    };
  });
}

}  // namespace palpate::app
