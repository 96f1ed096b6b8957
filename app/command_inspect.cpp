// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/inspect/summary.hpp"

namespace palpate::app {

void add_inspect_command(CLI::App& root, Action& action) {
  struct Options {
    std::string file;
    bool json = false;
  };
  CLI::App* command = root.add_subcommand("inspect", "Checks an artifact and prints its contents");
  command->footer("Example: palpate inspect out/cylinder/library.h5 --json");
  const auto options = std::make_shared<Options>();
  command
      ->add_option("FILE", options->file,
                   "body.h5, curves.h5, library.h5, library.plib, deformation.pdef, recording.h5, "
                   "the journal of "
                   "a campaign, of hold-out points or of a session, or the fields of a site")
      ->required();
  command->add_flag("--json", options->json,
                    "Print JSON, including the resolved case of each stage");
  command->callback([options, &action] {
    action = [options] {
      const nlohmann::ordered_json summary = summarize_artifact(options->file);
      if (options->json) {
        print_line(summary.dump(2));
        return kExitDone;
      }
      std::string text = summary_text(summary);
      if (text.ends_with('\n')) text.pop_back();
      print_text(text);
      return kExitDone;
    };
  });
}

}  // namespace palpate::app
