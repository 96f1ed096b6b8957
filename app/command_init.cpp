// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <cctype>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/init/timely_case.hpp"
#include "format/crash_safe_file.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
  std::string file, output, unit;
  std::optional<int> sites;
  double minutes = FirstWishes{}.minutes;
  int threads = 0;
};

/// `liver.stl` -> `liver.toml`, in the current folder.
fs::path case_path(const InitOptions& options) {
  if (!options.output.empty()) return options.output;
  fs::path name = fs::path(options.file).filename().replace_extension(".toml");
  return name.stem().extension() == ".nii" ? name.stem().replace_extension(".toml") : name;
}

/// The name of the case, where that of its file cannot name a folder; else empty.
std::string name_instead_of(const std::string& stem) {
  std::string name = stem;
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '_') letter = '-';
  return name == stem ? std::string() : name;
}

int write_first_case(const InitOptions& options) {
  const fs::path target = case_path(options);
  if (fs::exists(target))
    refuse(target.string(), "the file exists", "remove it, or give another name with -o");
  CaseOf made{read_body_file(options.file, options.unit), {}, "", target};
  made.base = find_base(made.body.surface);
  made.name = name_instead_of(target.stem().string());
  // Never writes a case that would be refused.
  const FirstCase first = timely_case(
      made, {options.sites, options.minutes, options.threads > 0 ? options.threads : processors()});
  write_file_crash_safely(target, first.toml);
  for (const std::string& remark : first.remarks) say("  {}", remark);
  const std::string name = target.string();
  const bool plain = name.find(' ') == std::string::npos;
  say("init: {}; next: {}palpate build {}", name,
      first.is_refused ? "change it as said above, then " : "", plain ? name : '"' + name + '"');
  return kExitDone;
}

}  // namespace

void add_init_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("init", "Surface, volume mesh or segmentation -> a first case that runs");
  command->footer("Example: palpate init data/bodies/sofa/liver.obj -o liver.toml");
  const auto options = std::make_shared<InitOptions>();
  command
      ->add_option("FILE", options->file,
                   "Surface (OFF, OBJ, PLY, STL, VTP, VTK), volume mesh or segmentation")
      ->required();
  command->add_option("-o,--output", options->output,
                      "Case file to write (default: name of FILE, .toml, in the current folder)");
  command->add_option(
      "--unit", options->unit,
      "Length unit of FILE: mm, cm, dm, um, nm, in or m (default: what FILE states, "
      "else a guess from its size)");
  command
      ->add_option("--sites", options->sites,
                   "About how many sites the case has (default: 200, or fewer to save time)")
      ->check(CLI::Range(10, 100000));
  command
      ->add_option(
          "--minutes", options->minutes,
          "Time that the campaign may take: trial sites are pressed, and patches, refinement and "
          "depth chosen for it; 0: any, without trial")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100000.0));
  command->add_option("--threads", options->threads, "Threads (default: one for each processor)")
      ->check(CLI::Range(1, 4096));
  command->callback(
      [options, &action] { action = [options] { return write_first_case(*options); }; });
}

}  // namespace palpate::app
