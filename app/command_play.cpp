// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/play/browser.hpp"
#include "app/play/drawn.hpp"
#include "app/play/shipped.hpp"
#include "app/report/play_page.hpp"
#include "app/run/device_choice.hpp"

namespace palpate::app {
namespace {

struct PlayOptions {
  std::string library, out, device;
  bool closed = false;
};

int list_shipped() {
  const std::filesystem::path folder = shipped_folder();
  const auto libraries = shipped_libraries(folder);
  if (libraries.empty())
    answer("play: no libraries are in {}; `palpate play FILE` takes a library.h5", folder.string());
  else
    answer("play: ready to be touched with `palpate play NAME`:");
  for (const ShippedLibrary& library : libraries) {
    answer("  {:12} {:4} kB  {}", library.name,
           (std::filesystem::file_size(library.file) + 999) / 1000, library.about);
  }
  return kExitDone;
}

int play(const PlayOptions& options) {
  if (options.library.empty()) return list_shipped();
  const std::filesystem::path file = chosen_library(options.library, shipped_folder());
  if (!options.device.empty()) {
    require_known_device(options.device);
    answer("play: on a device: palpate run {} --device {}{}", file.string(), options.device,
           options.device == kSimulatedDevice ? "" : " --profile PROFILE");
    return kExitDone;
  }
  const Library library = read_library(file);
  const std::filesystem::path page =
      options.out.empty() ? cached_page(file.stem().string()) : std::filesystem::path(options.out);
  const DrawnBody drawn = drawn_body(file, library);
  report::write_play_page(library, drawn.to_draw(), page);
  const bool shown = !options.closed && open_in_browser(std::filesystem::absolute(page).string());
  say("play: {}{}", page.string(), shown ? "" : " (open it in a browser)");
  return kExitDone;
}

}  // namespace

void add_play_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "play",
      "A library as a page that is touched with the mouse; alone it lists the ready-made ones");
  command->footer("Example: palpate play liver");
  const auto options = std::make_shared<PlayOptions>();
  command->add_option("LIBRARY", options->library,
                      "Name of a ready-made library, a library.h5, a .plib or a folder with one");
  command->add_option("--out", options->out,
                      "The page (default: NAME.html in the cache folder of the user)");
  command->add_flag("--no-open", options->closed, "Write the page and start no browser");
  command->add_option("--device", options->device,
                      "Print the command that renders the library on this device instead");
  command->callback([options, &action] { action = [options] { return play(*options); }; });
}

}  // namespace palpate::app
