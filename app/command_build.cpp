// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/estimate.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stages.hpp"

namespace palpate::app {

void add_build_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "build",
      "All stages from the case to library.h5; skips those whose artifacts are up to date");
  command->footer("Example: palpate build data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_stage_options(*command, ThreadsOption::Present);
  const auto last = std::make_shared<std::string>(stage_name(Stage::Certify));
  std::map<std::string, Stage> stages;
  for (const Stage stage : {Stage::Mesh, Stage::Precompute, Stage::Fit, Stage::Certify})
    stages.emplace(stage_name(stage), stage);
  command->add_option("--until", *last, "Last stage: mesh, precompute, fit or certify")
      ->check(CLI::IsMember(stages))
      ->option_text("STAGE");
  const auto strict = std::make_shared<bool>(false);
  command->add_flag("--strict", *strict, kStrictHelp);
  const auto estimate = std::make_shared<bool>(false);
  command->add_flag("--estimate", *estimate, kEstimateHelp);
  command->callback([options, last, stages, strict, estimate, &action] {
    action = [options, last, stages, strict, estimate] {
      if (*estimate) {
        estimate_build(open_workspace(*options), event_sink(*options));
        return kExitDone;
      }
      const SiteCounts counts =
          run_build(open_workspace(*options), stages.at(*last), event_sink(*options));
      return exit_code_of(counts, *strict);
    };
  });
}

}  // namespace palpate::app
