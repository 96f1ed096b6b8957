// SPDX-License-Identifier: AGPL-3.0-or-later
// The subcommands of `palpate`. Each registers itself with the parser. The parsed subcommand stores
// its work in `action`, which returns the exit code.
#pragma once

#include <functional>

namespace CLI {  // NOLINT(readability-identifier-naming): a name of the library
class App;
}

namespace palpate::app {

/// Exit codes in addition to those of ErrorKind.
inline constexpr int kExitDone = 0;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitSomeSitesFailed = 4;
inline constexpr int kExitIncomplete =
    4;  ///< the recording of a damaged journal, or a session of guesses

/// Exit code of a campaign. Some sites that ended early leave a usable library: they are a warning,
/// unless the caller is strict.
template <class Counts>
int exit_code_of(const Counts& counts, bool strict) {
  const bool good = counts.all_complete() || (!strict && counts.usable());
  return good ? kExitDone : kExitSomeSitesFailed;
}
inline constexpr const char* kStrictHelp =
    "Exit with 4 if any site ended early, even if the library is usable without it";

inline constexpr const char* kStrictSessionHelp =
    "Exit with 4 if any step went beyond the deepest sample, where forces are extrapolated";

using Action = std::function<int()>;

void add_init_command(CLI::App& root, Action& action);
void add_doctor_command(CLI::App& root, Action& action);
void add_check_command(CLI::App& root, Action& action);
void add_mesh_command(CLI::App& root, Action& action);
void add_merge_command(CLI::App& root, Action& action);
void add_precompute_command(CLI::App& root, Action& action);
void add_fit_command(CLI::App& root, Action& action);
void add_calibrate_command(CLI::App& root, Action& action);
/// `palpate calibrate relaxation`, a part of `palpate calibrate`.
void add_calibrate_relaxation(CLI::App& calibrate, Action& action);
/// `palpate calibrate slab`, another one.
void add_calibrate_slab(CLI::App& calibrate, Action& action);
void add_compare_command(CLI::App& root, Action& action);
void add_certify_command(CLI::App& root, Action& action);
void add_build_command(CLI::App& root, Action& action);
void add_simulate_command(CLI::App& root, Action& action);
void add_inspect_command(CLI::App& root, Action& action);
void add_export_command(CLI::App& root, Action& action);
void add_import_command(CLI::App& root, Action& action);
void add_rescale_command(CLI::App& root, Action& action);
void add_identify_command(CLI::App& root, Action& action);
void add_run_command(CLI::App& root, Action& action);
void add_watch_command(CLI::App& root, Action& action);
void add_recover_command(CLI::App& root, Action& action);
void add_replay_command(CLI::App& root, Action& action);
void add_experiment_command(CLI::App& root, Action& action);
void add_play_command(CLI::App& root, Action& action);
void add_report_command(CLI::App& root, Action& action);
void add_manual_command(CLI::App& root, Action& action);
void add_completion_command(CLI::App& root, Action& action);

}  // namespace palpate::app
