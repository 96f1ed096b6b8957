// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/patch_body.hpp"

#include "app/measured/record_reader.hpp"
#include "format/error.hpp"
#include "mesher/patch/patch.hpp"

namespace palpate::app {

bool makes_body(const Sidecar& sidecar) {
  return !sidecar.batches.empty() && sidecar.presses.empty() && sidecar.robot_logs.empty();
}

PatchBody patch_body(const std::filesystem::path& sidecar_file, const std::string& tool) {
  const RecordReader reader(sidecar_file, tool);
  if (!makes_body(reader.sidecar())) {
    refuse(sidecar_file.string(), "a surface is made of the records of [[batch]] alone",
           "give presses and logs of single sites a body with --body");
  }
  PatchBody result;
  Body& body = result.body;
  std::vector<mesher::ContactPoint> points;
  for (const BatchFileSection& batch : reader.sidecar().batches) {
    const measured::CsvTable table = reader.table(batch);
    for (const measured::BatchSite& site : reader.batch(batch, table)) {
      points.push_back({site.name, site.contact, site.outward});
      body.response.node.push_back(static_cast<std::int32_t>(body.nodes.size()));
      body.response.inward.push_back(-site.outward);
      body.response.is_site.push_back(1);
      body.nodes.push_back(site.contact);
    }
  }
  mesher::Patch patch = mesher::make_patch(points, sidecar_file.string());
  body.name = reader.sidecar().name;
  body.boundary = patch.triangles;
  body.response.triangles = std::move(patch.triangles);
  result.spacing = patch.spacing;
  result.steepest = patch.steepest;
  result.largest_turn = patch.largest_turn;
  result.warnings = std::move(patch.warnings);
  return result;
}

}  // namespace palpate::app
