// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/pipeline/stages.hpp"
#include "app/report/preview.hpp"
#include "format/body.hpp"

namespace palpate::app {

namespace {

void write_preview(const Workspace& space, const EventSink& emit) {
  const std::filesystem::path repair = space.out / "repair.json", page = space.out / "preview.html";
  std::ostringstream text;
  if (std::filesystem::exists(repair)) text << std::ifstream(repair, std::ios::binary).rdbuf();
  report::write_preview(read_body(space.body()), text.str(), page);
  emit(FileWritten{"mesh", page});
}

}  // namespace

void add_mesh_command(CLI::App& root, Action& action) {
  CLI::App* command = root.add_subcommand(
      "mesh", "Surface and case -> body.h5: check, remesh, fill with tetrahedra");
  command->footer("Example: palpate mesh data/cases/cylinder.toml --preview");
  const auto options = add_stage_options(*command, ThreadsOption::Absent);
  const auto preview = std::make_shared<bool>(false);
  command->add_flag("--preview", *preview,
                    "Write preview.html too: the body with its supports, press zones and sites");
  command->callback([options, preview, &action] {
    action = [options, preview] {
      const Workspace space = open_workspace(*options);
      const EventSink emit = event_sink(*options);
      run_mesh(space, emit);
      if (*preview) write_preview(space, emit);
      return kExitDone;
    };
  });
}

}  // namespace palpate::app
