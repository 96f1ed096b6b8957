// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"

namespace palpate::app {

void add_certify_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("certify", "library.h5 -> library.h5 with its passivity certificate");
  command->footer("Example: palpate certify data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_case_options(*command, ThreadsOption::Absent);
  command->callback([options, &action] {
    action = [options] {
      run_certify(open_workspace(*options));
      return kExitDone;
    };
  });
}

}  // namespace palpate::app
