// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <memory>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"

namespace palpate::app {

void add_certify_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("certify", "Adds the passivity certificate to library.h5");
  command->footer(
      "Examples:\n"
      "  palpate certify data/cases/cylinder.toml --out out/cylinder\n"
      "  palpate certify data/cases/cylinder.toml --out out/cylinder --rate 2000 --device "
      "data/devices/paper-simulated.toml --soften soft.h5\n"
      "  palpate certify data/cases/cylinder.toml --out out/cylinder --challenge 400");
  const auto options = add_stage_options(*command, ThreadsOption::Absent);
  const auto at_rate = std::make_shared<RateOptions>();
  CLI::Option* rate = command
                          ->add_option("--rate", at_rate->rate,
                                       "Hz: report the certifiable stiffness at this sampling rate "
                                       "instead of writing a certificate")
                          ->check(CLI::Range(1.0, 1e6));
  command->add_option("--device", at_rate->device, "Device profile (default: those of the case)")
      ->needs(rate);
  command
      ->add_option("--soften", at_rate->softened,
                   "Write a library here, with slopes capped until it is certified at the rate")
      ->needs(rate);
  const auto tries = std::make_shared<int>(0);
  command
      ->add_option(
          "--challenge", *tries,
          "Instead, search so often in each triangle for forces that exceed the bounds of the "
          "certificate")
      ->check(CLI::Range(1, 1000000))
      ->excludes(rate);
  command->callback([options, at_rate, tries, &action] {
    action = [options, at_rate, tries] {
      const Workspace space = open_workspace(*options);
      const EventSink emit = event_sink(*options);
      if (*tries > 0) {
        run_challenge(space, *tries, emit);
      } else if (at_rate->rate > 0) {
        run_certify_at_rate(space, *at_rate, emit);
      } else {
        run_certify(space, emit);
      }
      return kExitDone;
    };
  });
}

}  // namespace palpate::app
