// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/measured_stages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>

#include "app/measured/import.hpp"
#include "app/measured/patch_body.hpp"
#include "app/pipeline/freshness.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "app/pipeline/stages.hpp"
#include "format/body.hpp"
#include "format/crash_safe_file.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

double degrees(double angle) {
  return angle * 180 / std::numbers::pi;
}

}  // namespace

void run_measured_surface(const Workspace& space, const EventSink& emit) {
  PatchBody patch = patch_body(records_of(space));
  for (const std::string& warning : patch.warnings) emit(Warning{"mesh", warning});
  if (!patch.refused.empty())
    emit(Warning{"mesh", fmt::format("not in the surface, as `precompute` explains: {}",
                                     fmt::join(patch.refused, ", "))});
  emit(LogLine{"mesh",
               fmt::format("surface of {}, {} apart; facets up to {:.0f} degrees off "
                           "the mean normal, normals up to {:.0f} degrees off the facets",
                           count_text(patch.body.nodes.size(), "site"), length_text(patch.spacing),
                           degrees(patch.steepest), degrees(patch.largest_turn))});
  patch.body.name = space.c.name;
  patch.body.provenance.steps.push_back(make_stage_step(space, Stage::Mesh, {}));
  write_body(space.body(), patch.body);
  emit(FileWritten{"mesh", space.body()});
}

SiteCounts run_measured_curves(const Workspace& space, const EventSink& emit) {
  const Body body = read_input(space.body(), "mesh", read_body);
  prepare_output(space.out);
  Import import = import_measurement(records_of(space), space.body());
  append(import.curves.provenance, import.curves.provenance,
         make_stage_step(space, Stage::Precompute, {}));
  for (const auto& refused : import.account["refused"])
    emit(Warning{"precompute", "left out: " + refused["reason"].get<std::string>()});
  for (const auto& warning : import.account["warnings"])
    emit(Warning{"precompute", warning.get<std::string>()});
  write_curves(space.curves(), import.curves);
  write_file_crash_safely(space.out / "import.json", import.account.dump(2) + "\n");
  emit(LogLine{
      "precompute",
      fmt::format("{} at {} of {}", count_text(import.account["records"].size(), "record"),
                  import.curves.sites.size(), count_text(body.response.node.size(), "site"))});
  emit(FileWritten{"precompute", space.curves()});
  return count_sites(import.curves);
}

}  // namespace palpate::app
