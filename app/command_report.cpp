// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <fstream>
#include <optional>
#include <sstream>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/report/report.hpp"
#include "format/sha256.hpp"

namespace palpate::app {
namespace {

std::string text_if_there(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return {};
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

int report(const CaseOptions& options) {
  const Workspace space = open_workspace(options);
  const Body body = read_body(space.body());
  const Curves curves = read_curves(space.curves());
  const Library library = read_library(space.library());
  std::optional<report::SessionDigest> session;
  if (std::filesystem::exists(space.recording())) {
    RecordingReader reader(space.recording());
    session = report::digest(reader);
  }
  ReportInput input;
  input.body = &body;
  input.curves = &curves;
  input.library = &library;
  input.session = session ? &*session : nullptr;
  input.library_bytes = std::filesystem::file_size(space.library());
  input.library_sha256 = sha256_of_file(space.library());
  input.comparison = text_if_there(space.out / "comparison.json");
  input.calibration = text_if_there(space.out / "calibration.json");
  input.repair = text_if_there(space.out / "repair.json");
  input.deformation = text_if_there(space.deformation());
  input.fidelity = text_if_there(space.out / "fidelity.json");
  write_report(input, space.report());
  say("report: {}{}", space.report().string(),
      session ? "" : " (without a session; `palpate simulate` records one)");
  return kExitDone;
}

}  // namespace

void add_report_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("report", "Artifacts of a case -> report.html, a single file");
  command->footer("Example: palpate report data/cases/cylinder.toml --out out/cylinder");
  const auto options = add_case_options(*command);
  command->callback([options, &action] { action = [options] { return report(*options); }; });
}

}  // namespace palpate::app
