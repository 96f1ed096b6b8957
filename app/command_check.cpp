// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/console.hpp"
#include "app/init/check_surface.hpp"
#include "app/init/first_case.hpp"
#include "format/crash_safe_file.hpp"

namespace palpate::app {
namespace {

struct CheckOptions {
  std::string file, unit, out, faults;
  bool largest_part = false;
};

/// @throws Error(Configuration) where the name does not end so.
void require_ending(const std::string& option, const std::string& file, const std::string& ending) {
  if (file.empty() || std::filesystem::path(file).extension() == ending) return;
  refuse(option + " " + file, "the file would be written as " + ending,
         "give a name that ends in " + ending);
}

int check_file(const CheckOptions& options) {
  require_ending("--out", options.out, ".ply");
  require_ending("--faults", options.faults, ".vtp");
  const SurfaceCheck found = check_surface(options.file, options.unit, options.largest_part);
  say("{}: {} points, {} faces; unit {}, {}", options.file, found.points, found.faces,
      found.file.unit.symbol, unit_reason(found.file, found.raw_size));
  for (const std::string& fault : found.faults) say("  fault: {}", fault);
  for (const std::string& step : found.repairs)
    say("  {}: {}", found.is_sound() ? "surface" : "repair", step);
  if (!options.faults.empty() && !found.faulty.faults.empty()) {
    write_file_crash_safely(options.faults, mesher::vtp_text(found.faulty));
    say("  faulty faces: {}", options.faults);
  }
  if (found.refusal) throw Error(*found.refusal);
  if (!options.out.empty()) {
    write_file_crash_safely(options.out, ply_text(found.file.surface, found.file.unit.si));
    say("  repaired surface: {}", options.out);
  }
  say("check: {}", found.is_sound() ? "sound: `palpate mesh` uses it as it is"
                                    : "has faults; `palpate mesh` repairs them as stated");
  return kExitDone;
}

}  // namespace

void add_check_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("check", "What is wrong with a surface, and what its repair would do");
  command->footer(
      "Exit code 3: the surface would be refused. Nothing is written without --out or --faults.\n"
      "Example: palpate check tests/data/surfaces/sofa/head.obj --unit cm");
  const auto options = std::make_shared<CheckOptions>();
  command->add_option("FILE", options->file, "Surface (OFF, OBJ, PLY, STL, VTP, VTK)")->required();
  command->add_option("--unit", options->unit,
                      "Length unit of FILE: mm, cm, dm, um, nm, in or m (default: a guess)");
  command->add_flag("--largest-part", options->largest_part,
                    "Of several parts keep the one with the largest area, as parts = \"largest\"");
  command->add_option("--out", options->out, "PLY file to write the repaired surface to");
  command->add_option("--faults", options->faults,
                      "VTP file to write the faulty faces to, in the unit of FILE");
  command->callback([options, &action] { action = [options] { return check_file(*options); }; });
}

}  // namespace palpate::app
