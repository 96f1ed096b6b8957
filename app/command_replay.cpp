// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/replay/replay.hpp"
#include "format/error.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

struct Options {
  std::string recording, library, out;
};

void require_library_of(const Recording& recording, const Options& options) {
  if (recording.library_sha256.empty()) return;
  if (sha256_of_file(options.library) == recording.library_sha256) return;
  throw Error(ErrorKind::Configuration, options.library, "is not the library that was felt",
              "give the one with sha256 " + recording.library_sha256);
}

int replay_recording(const Options& options) {
  const Recording recorded = read_recording(options.recording);
  require_library_of(recorded, options);
  const palpate_library body(read_library(options.library));
  Recording again = replay(recorded, body);
  if (!options.out.empty()) {
    again.provenance.steps.push_back(
        make_provenance_step("replay", "", {options.recording, options.library}));
    write_recording(options.out, again);
  }
  require_same(recorded, again, options.recording);
  say("replay: {} steps, forces, energies and contact points the same to the bit",
      recorded.steps.size());
  return kExitDone;
}

}  // namespace

void add_replay_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "replay", "A recorded motion through the model again: the same forces, or where they part");
  command->footer(
      "Example: palpate replay out/cylinder/recording.h5 --library out/cylinder/library.h5");
  const auto options = std::make_shared<Options>();
  command->add_option("RECORDING", options->recording, "Of a session (recording.h5)")->required();
  command->add_option("--library", options->library, "The library that was felt (library.h5)")
      ->required();
  command->add_option("--out", options->out, "Write what is felt now (recording.h5)");
  command->callback(
      [options, &action] { action = [options] { return replay_recording(*options); }; });
}

}  // namespace palpate::app
