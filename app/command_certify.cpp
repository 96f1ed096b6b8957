// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <memory>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"

namespace palpate::app {

void add_certify_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("certify", "library.h5 -> library.h5 with its passivity certificate");
  command->footer(
      "Examples:\n"
      "  palpate certify data/cases/cylinder.toml --out out/cylinder\n"
      "  palpate certify data/cases/cylinder.toml --out out/cylinder --rate 2000 --device "
      "data/devices/paper-simulated.toml --soften soft.h5\n"
      "  palpate certify data/cases/cylinder.toml --out out/cylinder --challenge 400");
  const auto options = add_case_options(*command, ThreadsOption::Absent);
  const auto keep = std::make_shared<KeepOptions>();
  CLI::Option* rate = command
                          ->add_option("--rate", keep->rate,
                                       "Hz: tell the stiffest response that may be kept at this "
                                       "rate, instead of certifying")
                          ->check(CLI::Range(1.0, 1e6));
  command->add_option("--device", keep->device, "Device profile (default: those of the case)")
      ->needs(rate);
  command
      ->add_option("--soften", keep->softened,
                   "Write a library here whose stiff slopes are capped until it is certified")
      ->needs(rate);
  const auto tries = std::make_shared<int>(0);
  command
      ->add_option("--challenge", *tries,
                   "Instead, look for forces steeper than the certificate says, so often in each "
                   "triangle")
      ->check(CLI::Range(1, 1000000))
      ->excludes(rate);
  command->callback([options, keep, tries, &action] {
    action = [options, keep, tries] {
      const Workspace space = open_workspace(*options);
      if (*tries > 0) {
        run_challenge(space, *tries);
      } else if (keep->rate > 0) {
        run_keep(space, *keep);
      } else {
        run_certify(space);
      }
      return kExitDone;
    };
  });
}

}  // namespace palpate::app
