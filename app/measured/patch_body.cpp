// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/patch_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <utility>

#include "app/measured/record_reader.hpp"
#include "format/error.hpp"
#include "mesher/patch/patch.hpp"

namespace palpate::app {

namespace {

struct UsableSites {
  std::vector<mesher::ContactPoint> points;
  std::vector<std::string> refused;
  std::optional<Error> first_reason;
};

/// Those of all batches; a batch that cannot be read does not take the others with it.
UsableSites usable_sites(const RecordReader& reader) {
  UsableSites sites;
  const auto put_off = [&](const std::string& what, const Error& reason) {
    sites.refused.push_back(what);
    if (!sites.first_reason) sites.first_reason = reason;
  };
  for (const BatchFileSection& section : reader.sidecar().batches) {
    try {
      const measured::Batch batch = reader.batch(section, reader.table(section));
      for (const measured::BatchSite& site : batch.sites)
        sites.points.push_back({site.name, site.contact, site.outward});
      for (const measured::RefusedSite& site : batch.refused) put_off(site.name, site.reason);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Configuration) throw;
      put_off(section.file, error);
    }
  }
  if (sites.points.empty() && sites.first_reason) throw *sites.first_reason;
  return sites;
}

/// The surface; where none can be made of the sites that are left, the refused ones are the cause.
mesher::Patch patch_of(const UsableSites& sites, const std::string& where) {
  try {
    return mesher::make_patch(sites.points, where);
  } catch (const Error& error) {
    if (!sites.first_reason) throw;
    throw Error(error.kind(), error.where(),
                fmt::format("{}; {} cannot be used ({})", error.problem(),
                            fmt::join(sites.refused, ", "), sites.first_reason->what()),
                error.remedy());
  }
}

}  // namespace

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
  UsableSites usable = usable_sites(reader);
  for (const mesher::ContactPoint& point : usable.points) {
    body.response.node.push_back(static_cast<std::int32_t>(body.nodes.size()));
    body.response.inward.push_back(-point.outward);
    body.response.is_site.push_back(1);
    body.nodes.push_back(point.position);
  }
  mesher::Patch patch = patch_of(usable, sidecar_file.string());
  result.refused = std::move(usable.refused);
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
