// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"

namespace palpate::app {

void add_fit_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("fit", "curves.h5 -> library.h5: compact passive responses");
  command->footer("Example: palpate fit data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_stage_options(*command, ThreadsOption::Absent);
  command->callback([options, &action] {
    action = [options] {
      run_fit(open_workspace(*options), event_sink(*options));
      return kExitDone;
    };
  });
}

}  // namespace palpate::app
