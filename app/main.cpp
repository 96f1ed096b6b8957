// SPDX-License-Identifier: AGPL-3.0-or-later
// The `palpate` command.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "app/blas_kernel.hpp"
#include "app/command.hpp"
#include "app/command_line/help.hpp"
#include "app/command_line/words.hpp"
#include "app/console.hpp"
#include "format/error.hpp"
#include "format/provenance.hpp"

namespace palpate::app {
namespace {

int fail(std::string_view text, int exit_code) {
  std::fflush(stdout);
  console().err.line(error_line(text, console().err.colour));
  return exit_code;
}

int run(const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    return fail(error.what(), static_cast<int>(error.kind()));
  } catch (const std::bad_alloc&) {
    return fail("out of memory; use a coarser mesh, fewer threads or --memory",
                static_cast<int>(ErrorKind::Internal));
  } catch (const std::exception& error) {
    return fail(std::string("internal error: ") + error.what() + "; please report it",
                static_cast<int>(ErrorKind::Internal));
  }
}

void add_commands(CLI::App& root, Action& action) {
  add_init_command(root, action);
  add_check_command(root, action);
  add_build_command(root, action);
  add_mesh_command(root, action);
  add_precompute_command(root, action);
  add_merge_command(root, action);
  add_fit_command(root, action);
  add_certify_command(root, action);
  add_simulate_command(root, action);
  add_inspect_command(root, action);
  add_export_command(root, action);
  add_import_command(root, action);
  add_compare_command(root, action);
  add_rescale_command(root, action);
  add_calibrate_command(root, action);
  add_report_command(root, action);
  add_play_command(root, action);
  add_identify_command(root, action);
  add_run_command(root, action);
  add_watch_command(root, action);
  add_recover_command(root, action);
  add_replay_command(root, action);
  add_experiment_command(root, action);
  add_manual_command(root, action);
  add_completion_command(root, action);
  add_doctor_command(root, action);
}

void add_common_options(CLI::App& root) {
  root.set_version_flag("-V,--version", creator_text());
  CLI::Option* quiet = root.add_flag_function(
      "-q,--quiet", [](std::int64_t) { console().verbosity = Verbosity::Quiet; },
      "Print warnings, errors and results that were asked for only");
  root.add_flag_function(
          "-v,--verbose", [](std::int64_t) { console().verbosity = Verbosity::Verbose; },
          "Print every site, too")
      ->excludes(quiet);
}

int finish(int exit_code) {
  if (all_printed()) return exit_code;
  return fail("standard output: not everything could be written; free some space",
              static_cast<int>(ErrorKind::Internal));
}

int parse_and_run(int count, char** arguments) {
  CLI::App root{"palpate: precomputes the indentation of a soft body and renders it in real time",
                "palpate"};
  root.footer(
      "Exit codes: 0 success, 1 internal error or full disk, 2 usage,\n"
      "configuration, files or device, 3 unusable geometry, 4 finished, but\n"
      "incomplete: more than a twentieth of the sites have no response, any\n"
      "ended early with --strict, hold-out points failed, records were refused,\n"
      "a constant of a device was not identified, a journal was damaged, or\n"
      "with --strict a session went beyond the computed depth.\n"
      "'palpate help SUBCOMMAND' explains a subcommand; --quiet and --verbose\n"
      "stand before or after it.\n"
      "Example: palpate build data/cases/liver.toml");
  root.formatter(help_formatter(console().out.columns));  // inherited by the subcommands
  root.require_subcommand(1);
  root.fallthrough();  // inherited by the subcommands
  Action action;
  add_common_options(root);
  add_commands(root, action);
  const std::vector<std::string> words = help_as_option({arguments + 1, arguments + count});
  const std::string unknown = unknown_word(root, words);
  if (!unknown.empty()) return fail("command line: " + unknown, kExitUsage);
  try {
    root.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 starts at the back
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return root.exit(error);
    return fail(std::string("command line: ") + error.what() + "; see '" + help_for(root) + "'",
                kExitUsage);
  }
  return finish(run(action));
}

}  // namespace
}  // namespace palpate::app

int main(int count, char** arguments) {
  try {
    palpate::app::ensure_blas_kernel(arguments);
    palpate::app::report_failed_writes();
    return palpate::app::parse_and_run(count, arguments);
  } catch (...) {  // out of memory for the message itself
    std::fputs("error: out of memory\n", stderr);
    return static_cast<int>(palpate::ErrorKind::Internal);
  }
}
