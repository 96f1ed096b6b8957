// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <thread>

#include "app/console.hpp"
#include "app/interruption.hpp"
#include "app/pipeline/json_sink.hpp"
#include "app/pipeline/size_of_body.hpp"
#include "app/pipeline/text_sink.hpp"
#include "format/position_text.hpp"

namespace palpate::app {

namespace {

/// That of the file of the body; a header that states its own is in mm, and so are records.
Unit unit_of_coordinates(const mesher::Settings& mesh) {
  if (!mesh.volume_mesh.path.empty()) return unit_of_length(mesh.volume_mesh.unit);
  if (!mesh.image.path.empty()) return unit_of_length(mesh.image.unit);
  return unit_of_length(mesh.surface.path.empty() ? 1e-3 : mesh.surface.unit);
}

bool is_size(std::string text) {
  try {
    return CLI::AsSizeValue(true)(text).empty();
  } catch (const CLI::ValidationError&) {
    return false;
  }
}

/// "" for a number with its unit, "8GB" or "500 MiB": 8 alone would be bytes.
std::string problem_of_size(const std::string& text) {
  const bool has_unit =
      std::any_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
  if (has_unit && is_size(text)) return {};
  return fmt::format("'{}' is no number with a unit of memory; write for example 8GB", text);
}

}  // namespace

std::shared_ptr<CaseOptions> add_case_options(CLI::App& command, ThreadsOption threads) {
  auto options = std::make_shared<CaseOptions>();
  command.add_option("CASE", options->case_file, "Case file (TOML), see docs/cases.md")->required();
  command.add_option("--out", options->out,
                     "Folder of the artifacts (default: output.folder of the case, or out/NAME)");
  if (threads == ThreadsOption::Present) {
    command.add_option("--threads", options->threads, "Threads (default: one for each processor)")
        ->check(CLI::Range(1, 4096));
    command
        .add_option("--memory", options->memory,
                    "Memory that the process may use, e.g. 8GB; fewer sites then run concurrently")
        ->transform(CLI::AsSizeValue(true))
        ->transform(CLI::Validator(problem_of_size, ""))
        ->option_text("SIZE");
  }
  return options;
}

std::shared_ptr<CaseOptions> add_stage_options(CLI::App& command, ThreadsOption threads) {
  auto options = add_case_options(command, threads);
  command.add_flag("--json", options->json,
                   "Print events as JSON objects, one on each line; see docs/campaigns.md");
  return options;
}

EventSink event_sink(const CaseOptions& options) {
  if (options.json) return with_interruption_note(JsonSink(print_line));
  return with_interruption_note(TextSink(console()));
}

int processors() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Workspace open_workspace(const CaseOptions& options) {
  const std::filesystem::path folder = std::filesystem::path(options.case_file).parent_path();
  Workspace space = make_workspace(options.case_file, options.out,
                                   options.threads > 0 ? options.threads : processors(),
                                   [&](const Case& c) { return size_of_body(c.mesh, folder); });
  print_positions_in(unit_of_coordinates(space.c.mesh));
  space.memory = static_cast<double>(options.memory);
  return space;
}

}  // namespace palpate::app
