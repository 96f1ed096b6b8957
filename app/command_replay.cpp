// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/play/shipped.hpp"
#include "app/replay/replay.hpp"
#include "format/error.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

struct ReplayOptions {
  std::string recording, library, out;
};

void require_library_of(const RecordingHeading& recording, const ReplayOptions& options) {
  if (recording.library_sha256.empty()) return;
  if (sha256_of_file(options.library) == recording.library_sha256) return;
  throw Error(ErrorKind::Configuration, options.library, "it is not the library of the recording",
              "give the library with sha256 " + recording.library_sha256);
}

/// Opens the recording of the repeated session, if one is asked for.
void open_writer(std::optional<RecordingWriter>& writer, const RecordingReader& recorded,
                 const ReplayOptions& options) {
  if (options.out.empty()) return;
  RecordingHeading heading = recorded.heading();
  heading.provenance.steps.push_back(
      make_provenance_step("replay", "", {options.recording, options.library}));
  writer.emplace(options.out, heading, recorded.steps());
}

/// Streams the recording. With --out, writes every step even after a difference.
int replay_recording(ReplayOptions options) {
  options.library = chosen_library(options.library, shipped_folder()).string();
  RecordingReader recorded(options.recording);
  require_library_of(recorded.heading(), options);
  const palpate_library body(read_library(options.library));
  Replay model(recorded.heading(), body);
  std::optional<RecordingWriter> writer;
  open_writer(writer, recorded, options);
  std::optional<Difference> found;
  std::size_t number = 0;
  for (auto steps = recorded.next(); !steps.empty(); steps = recorded.next()) {
    for (RecordedStep& step : steps) {
      const RecordedStep again = model.step(step);
      if (!found) found = difference(step, again, number);
      if (found && !writer) refuse_difference(*found, recorded.heading(), options.recording);
      step = again;
      ++number;
    }
    if (writer) writer->append(steps);
  }
  if (writer) writer->commit();
  if (found) refuse_difference(*found, recorded.heading(), options.recording);
  say("replay: {} steps; forces, energies and contact points are identical to the bit", number);
  return kExitDone;
}

}  // namespace

void add_replay_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "replay", "Repeats a recorded motion and checks that the forces are identical to the bit");
  command->footer(
      "Example: palpate replay out/cylinder/recording.h5 --library out/cylinder/library.h5");
  const auto options = std::make_shared<ReplayOptions>();
  command->add_option("RECORDING", options->recording, "Recording of a session (recording.h5)")
      ->required();
  command
      ->add_option(
          "--library", options->library,
          "That of the session: a ready-made name, a library.h5, a .plib or a folder with one")
      ->required();
  command->add_option("--out", options->out, "Write the repeated session (recording.h5)");
  command->callback(
      [options, &action] { action = [options] { return replay_recording(*options); }; });
}

}  // namespace palpate::app
