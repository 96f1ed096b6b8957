// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "app/pipeline/events.hpp"
#include "app/pipeline/workspace.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): a name of the library
class App;
}

namespace palpate::app {

/// The arguments shared by the subcommands that work on a case.
struct CaseOptions {
  std::string case_file;
  std::string out;           ///< empty: as the case says
  int threads = 0;           ///< 0: one per processor
  std::uint64_t memory = 0;  ///< bytes; 0: no bound
  bool json = false;         ///< events as JSON
};

enum class ThreadsOption { Absent, Present };

/// Adds CASE, --out and, for stages that compute in parallel, --threads and --memory.
std::shared_ptr<CaseOptions> add_case_options(CLI::App& command,
                                              ThreadsOption threads = ThreadsOption::Absent);

/// The same for a command that runs stages, with --json.
std::shared_ptr<CaseOptions> add_stage_options(CLI::App& command,
                                               ThreadsOption threads = ThreadsOption::Absent);

/// Prints events on the standard output, as text or as JSON.
EventSink event_sink(const CaseOptions& options);

/// Number of processors, the usual number of threads.
int processors();

Workspace open_workspace(const CaseOptions& options);

}  // namespace palpate::app
