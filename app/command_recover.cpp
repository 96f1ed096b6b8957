// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/record/report_recovery.hpp"
#include "format/error.hpp"

namespace palpate::app {

namespace {

struct RecoverOptions {
  std::string journal, out;
};

int recover_session(const RecoverOptions& options) {
  const std::filesystem::path journal = options.journal;
  std::filesystem::path out = options.out;
  if (out.empty()) {
    out = journal;
    out.replace_extension(".h5");
    if (std::filesystem::exists(out)) {
      throw Error(ErrorKind::Configuration, out.string(), "the file exists",
                  "name another file with --out");
    }
  }
  const Recovered recovered = recover(journal, out);
  report(recovered);
  return recovered.gaps.empty() ? kExitDone : kExitIncomplete;
}

}  // namespace

void add_recover_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "recover", "Writes the recording of an interrupted session from its journal");
  command->footer(
      "Steps behind damaged bytes are recovered too; each gap is a warning, the exit code is 4, "
      "and\n"
      "the journal is kept as recording.journal.damaged.\n"
      "Example: palpate recover recording.journal");
  const auto options = std::make_shared<RecoverOptions>();
  command->add_option("JOURNAL", options->journal, "Journal of run or simulate (recording.journal)")
      ->required();
  command->add_option("--out", options->out, "Recording (default: beside the journal)");
  command->callback(
      [options, &action] { action = [options] { return recover_session(*options); }; });
}

}  // namespace palpate::app
