// SPDX-License-Identifier: AGPL-3.0-or-later
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/play/browser.hpp"
#include "app/play/drawn.hpp"
#include "app/play/shipped.hpp"
#include "app/record/session_recorder.hpp"
#include "app/report/play_page.hpp"
#include "app/run/stop_on_interrupt.hpp"
#include "app/watch/journal_tail.hpp"
#include "app/watch/live_frame.hpp"
#include "app/watch/loopback_server.hpp"
#include "app/watch/step_text.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kFrame{33};

struct WatchOptions {
  std::string library, recording = "recording.h5";
  bool from_input = false;
  std::uint16_t port = 8024;
  bool closed = false;
};

std::string page_of(const fs::path& file, const Library& library) {
  const DrawnBody drawn = drawn_body(file, library);
  return report::watch_page(library, drawn.to_draw());
}

/// A program tells its steps and nothing else.
RecordingHeading heading_of_program(const Library& library) {
  RecordingHeading heading;
  heading.device = "a program";
  heading.friction = library.certificate.friction;
  return heading;
}

std::function<SessionNews()> source_of(const WatchOptions& options, const Library& library) {
  if (options.from_input) {
    const auto text = std::make_shared<StepText>(STDIN_FILENO, heading_of_program(library));
    return [text] { return text->poll(); };
  }
  const auto tail = std::make_shared<JournalTail>(journal_of(options.recording));
  return [tail] { return tail->poll(); };
}

int watch(const WatchOptions& options) {
  const fs::path file = chosen_library(options.library, shipped_folder());
  const Library library = read_library(file);
  LoopbackServer server(options.port, page_of(file, library));
  LiveFrames frames(sha256_of_file(file));
  const auto ask = source_of(options, library);
  const std::string address = "http://127.0.0.1:" + std::to_string(server.port()) + "/";
  const StopOnInterrupt stop_on_interrupt;
  server.publish(frames.next());
  const bool shown = !options.closed && open_in_browser(address);
  say("watch: {}{} shows the session of {}; end with Ctrl-C", address,
      shown ? "" : " (open it in a browser)",
      options.from_input ? "the standard input" : options.recording);
  while (!stop_on_interrupt.interrupted()) {
    const SessionNews news = ask();
    if (frames.see(news)) server.publish(frames.next());
    if (news.begun) say("watch: a session of {} has begun", news.begun->device);
    if (news.ended) say("watch: the session has ended");
    server.run_for(kFrame);
  }
  return kExitDone;
}

}  // namespace

void add_watch_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("watch", "Show a session of `palpate run` in the browser while it runs");
  command->footer("Example: palpate watch out/cylinder/library.h5 --recording recording.h5");
  const auto options = std::make_shared<WatchOptions>();
  command
      ->add_option(
          "LIBRARY", options->library,
          "That of the session: a ready-made name, a library.h5, a .plib or a folder with one")
      ->required();
  command->add_option("--recording", options->recording,
                      "What the session writes: --out of `palpate run` (default: recording.h5)");
  command->add_flag(
      "--stdin", options->from_input,
      "Steps from the standard input, with the columns of `palpate export` for recordings: "
      "of a force loop of your own");
  command->add_option("--port", options->port, "Of 127.0.0.1 (default: 8024); 0: any that is free");
  command->add_flag("--no-open", options->closed, "Start no browser");
  command->callback([options, &action] { action = [options] { return watch(*options); }; });
}

}  // namespace palpate::app
