// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"

namespace palpate::app {

void add_mesh_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "mesh", "Surface and case -> body.h5: check, remesh, fill with tetrahedra");
  command->footer("Example: palpate mesh data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_stage_options(*command, ThreadsOption::Absent);
  command->callback([options, &action] {
    action = [options] {
      run_mesh(open_workspace(*options), event_sink(*options));
      return kExitDone;
    };
  });
}

}  // namespace palpate::app
