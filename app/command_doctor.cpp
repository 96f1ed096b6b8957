// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/doctor/machine.hpp"
#include "fem/factor/cholesky.hpp"

namespace palpate::app {

void add_doctor_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "doctor", "What this machine offers to palpate: a line for each subject, ok or missing");
  command->footer("Example: palpate doctor");
  command->callback([&action] {
    action = [] {
      for (const Finding& found : findings(look_at_machine(fem::blas_kernel())))
        answer("{:<8} {}", found.is_ok ? "ok" : "missing", found.text);
      return kExitDone;
    };
  });
}

}  // namespace palpate::app
