// SPDX-License-Identifier: AGPL-3.0-or-later
// The `palpate` command.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "app/blas_kernel.hpp"
#include "app/case/nearest.hpp"
#include "app/command.hpp"
#include "format/error.hpp"
#include "format/provenance.hpp"

namespace palpate::app {
namespace {

/// Prints the error on one line.
int fail(std::string text, int exit_code) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::fflush(stdout);
  std::fprintf(stderr, "palpate: %s\n", text.c_str());
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
  add_run_command(root, action);
  add_recover_command(root, action);
  add_replay_command(root, action);
  add_experiment_command(root, action);
}

/// The message for an unknown subcommand: CLI11 would only say that one is missing.
std::string unknown_subcommand(const CLI::App& root, int count, char** arguments) {
  if (count < 2 || arguments[1][0] == '-') return {};
  std::vector<std::string> names;
  for (const CLI::App* command : root.get_subcommands({})) names.push_back(command->get_name());
  const std::string given = arguments[1];
  if (std::find(names.begin(), names.end(), given) != names.end()) return {};
  return "unknown subcommand '" + given + "'; the nearest is '" +
         std::string(nearest(given, {names.begin(), names.end()})) + "'";
}

int parse_and_run(int count, char** arguments) {
  CLI::App root{"palpate: precomputes the indentation of a soft body and renders it in real time"};
  root.footer(
      "Exit codes: 0 success, 1 internal error, 2 usage or configuration, 3 unusable geometry,\n"
      "4 finished, but some sites are incomplete.\n"
      "Example: palpate build data/cases/liver.toml");
  root.set_version_flag("--version", creator_text());
  root.require_subcommand(1);
  Action action;
  add_commands(root, action);
  const std::string unknown = unknown_subcommand(root, count, arguments);
  if (!unknown.empty()) return fail("command line: " + unknown, kExitUsage);
  try {
    root.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return root.exit(error);
    return fail(std::string("command line: ") + error.what() + "; see palpate --help", kExitUsage);
  }
  return run(action);
}

}  // namespace
}  // namespace palpate::app

int main(int count, char** arguments) {
  try {
    palpate::app::ensure_blas_kernel(arguments);
    return palpate::app::parse_and_run(count, arguments);
  } catch (...) {  // out of memory for the message itself
    std::fputs("palpate: internal error: out of memory\n", stderr);
    return static_cast<int>(palpate::ErrorKind::Internal);
  }
}
