// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <cctype>
#include <filesystem>
#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/init/counted_case.hpp"
#include "format/crash_safe_file.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
  std::string file, output, unit;
  int sites = 200;
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
  const BodyFile body = read_body_file(options.file, options.unit);
  const Base base = find_base(body.surface);
  // Never writes a case that would be refused.
  const FirstCase first =
      counted_case(body, base, options.sites, name_instead_of(target.stem().string()), target);
  write_file_crash_safely(target, first.toml);
  for (const std::string& remark : first.remarks) say("  {}", remark);
  say("init: {}; next: palpate build {}", target.string(), target.string());
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
  command->add_option("--unit", options->unit,
                      "Length unit of FILE: mm, cm, dm, um, in or m (default: what FILE states, "
                      "else a guess from its size)");
  command->add_option("--sites", options->sites, "About how many sites the case has")
      ->capture_default_str()
      ->check(CLI::Range(10, 100000));
  command->callback(
      [options, &action] { action = [options] { return write_first_case(*options); }; });
}

}  // namespace palpate::app
