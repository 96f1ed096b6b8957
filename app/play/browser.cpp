// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/play/browser.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>

#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

/// Empty where it is not set; XDG wants an empty one ignored too.
std::string from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

fs::path cache_folder() {
  if (const std::string cache = from_environment("XDG_CACHE_HOME"); !cache.empty()) return cache;
  if (const std::string home = from_environment("HOME"); !home.empty())
    return fs::path(home) / ".cache";
  return fs::temp_directory_path();
}

}  // namespace

fs::path cached_page(const std::string& name) {
  const fs::path folder = cache_folder() / "palpate";
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed)
    refuse(folder.string(), "cannot be made: " + failed.message(), "name the page with --out");
  return folder / (name + ".html");
}

bool open_in_browser(std::string page) {
  if (from_environment("DISPLAY").empty() && from_environment("WAYLAND_DISPLAY").empty())
    return false;
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&silent, stream, "/dev/null", O_WRONLY, 0);
  std::string program = "xdg-open";
  char* const arguments[] = {program.data(), page.data(), nullptr};
  pid_t browser = 0;
  const int failed = posix_spawnp(&browser, program.c_str(), &silent, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&silent);
  return failed == 0;
}

}  // namespace palpate::app
