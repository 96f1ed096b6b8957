// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "app/case_options.hpp"
#include "app/command.hpp"
#include "app/console.hpp"
#include "app/export/csv.hpp"
#include "app/pipeline/settings.hpp"
#include "app/vtkhdf/grids.hpp"
#include "format/crash_safe_file.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

void write(const vtkhdf::Grid& grid, const std::filesystem::path& file) {
  vtkhdf::write_vtkhdf(file, grid);
  say("export: {} (open it in ParaView)", file.string());
}

int export_body(const Workspace& space) {
  write(vtkhdf::body_grid(read_body(space.body())), space.out / "body.vtkhdf");
  return kExitDone;
}

int export_curves(const Workspace& space) {
  const std::filesystem::path file = space.out / "curves.csv";
  write_curves_csv(read_curves(space.curves()), file);
  say("export: {}", file.string());
  return kExitDone;
}

int export_library(const Workspace& space) {
  write(vtkhdf::library_grid(read_library(space.library()), space.c.indentation.depth),
        space.out / "library.vtkhdf");
  return kExitDone;
}

/// Solve the site again and keep the whole state, which the campaign does not.
int export_site(const Workspace& space, std::int32_t vertex) {
  const Body body = read_body(space.body());
  const fem::DeformedState state = fem::deformed_state(body, campaign_settings(space), vertex);
  const vtkhdf::DeformedFields fields{state.displacement, state.strain_energy_density,
                                      state.pressure};
  vtkhdf::Grid grid = vtkhdf::deformed_grid(body, fields);
  grid.provenance.steps.push_back(make_provenance_step(
      "export", resolved_toml(space.c), {space.body()}, {{"vertex", std::to_string(vertex)}}));
  say("site {}: depth {:.2f} mm, force {:.4f} N", vertex, state.sample.displacement * 1e3,
      norm(state.sample.force));
  write(grid, space.out / fmt::format("site-{}.vtkhdf", vertex));
  return kExitDone;
}

int export_recording(const std::filesystem::path& recording) {
  const std::filesystem::path file = std::filesystem::path(recording).replace_extension(".csv");
  write_file_crash_safely(file, recording_csv(read_recording(recording)));
  say("export: {}", file.string());
  return kExitDone;
}

/// Sessions on a device have no case.
void add_recording_part(CLI::App& parent, Action& action) {
  CLI::App* part = parent.add_subcommand("recording", "recording.h5 -> recording.csv beside it");
  part->footer("Example: palpate export recording out/cylinder/recording.h5");
  const auto file = std::make_shared<std::string>();
  part->add_option("RECORDING", *file, "Of a session (recording.h5)")->required();
  part->callback([file, &action] { action = [file] { return export_recording(*file); }; });
}

template <class Run>
CLI::App* add_part(CLI::App& parent, Action& action, const char* name, const char* about, Run run) {
  CLI::App* part = parent.add_subcommand(name, about);
  part->footer(fmt::format("Example: palpate export {} data/cases/cylinder.toml", name));
  const auto options = add_case_options(*part);
  part->callback([options, run, &action] {
    action = [options, run] {
      const Workspace space = open_workspace(*options);
      prepare_output(space.out);
      return run(space);
    };
  });
  return part;
}

}  // namespace

void add_export_command(CLI::App& root, Action& action) {
  CLI::App* command =
      root.add_subcommand("export", "Artifacts for other programs: ParaView (VTKHDF) and CSV");
  command->footer("Example: palpate export site data/cases/cylinder.toml --vertex 12");
  command->require_subcommand(1);
  add_part(*command, action, "body", "body.h5 -> body.vtkhdf", export_body);
  add_part(*command, action, "curves", "curves.h5 -> curves.csv", export_curves);
  add_part(*command, action, "library",
           "library.h5 -> library.vtkhdf, with the forces at the depth of the case",
           export_library);
  add_recording_part(*command, action);
  const auto vertex = std::make_shared<std::int32_t>(-1);
  CLI::App* site =
      add_part(*command, action, "site", "The body deformed at one site -> site-N.vtkhdf",
               [vertex](const Workspace& space) { return export_site(space, *vertex); });
  site->add_option("--vertex", *vertex, "Response vertex, as in curves.csv")->required();
}

}  // namespace palpate::app
