// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"

namespace palpate::app {

void add_merge_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "merge",
      "curves.I-of-N.h5 of several machines -> curves.h5; checks that every site is there once");
  command->footer("Example: palpate merge data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_stage_options(*command);
  const auto parts = std::make_shared<std::vector<std::string>>();
  command->add_option("PARTS", *parts, "Parts (default: every curves.I-of-N.h5 in the folder)");
  const auto strict = std::make_shared<bool>(false);
  command->add_flag("--strict", *strict, kStrictHelp);
  command->callback([options, parts, strict, &action] {
    action = [options, parts, strict] {
      const SiteCounts counts =
          run_merge(open_workspace(*options), {parts->begin(), parts->end()}, event_sink(*options));
      return exit_code_of(counts, *strict);
    };
  });
}

}  // namespace palpate::app
