// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "fitting/deformation/compress.hpp"
#include "format/deformation.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/sha256.hpp"
#include "format/site_fields.hpp"
#include "format/site_record.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

bool has_fields(const fs::path& folder, const SiteCurves& site) {
  if (!fs::exists(fields_file(folder, site.vertex))) return false;
  try {
    fields_of(folder, site);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::Configuration) throw;
    return false;
  }
  return true;
}

}  // namespace

SiteFields fields_of(const fs::path& folder, const SiteCurves& site) {
  const fs::path file = fields_file(folder, site.vertex);
  SiteFields fields = read_site_fields(file);
  if (fields.curves != sha256(site_bytes(site)) || fields.vertex != site.vertex)
    refuse(file.string(), "is of another campaign than the curves",
           "run 'palpate precompute' again");
  return fields;
}

void keep_fields_in(const fs::path& folder, int depths, fem::CampaignSettings& settings) {
  std::erase_if(settings.known, [&](const SiteCurves& site) { return !has_fields(folder, site); });
  prepare_output(folder);
  settings.field_depths = depths;
  settings.fields = [folder](const SiteFields& fields) {
    write_site_fields(fields_file(folder, fields.vertex), fields);
  };
}

void keep_fields(const Workspace& space, fem::CampaignSettings& settings) {
  const int depths = space.c.deformation.depths;
  if (depths > 0) keep_fields_in(space.fields(), depths, settings);
}

void fit_deformation(const Workspace& space, const Body& body, const Curves& curves,
                     const Library& library, const EventSink& emit) {
  if (space.c.deformation.depths == 0) {
    std::error_code none;
    fs::remove(space.deformation(), none);
    return;
  }
  std::vector<const SiteCurves*> sites;
  std::vector<std::int32_t> vertices;
  for (const SiteCurves& site : curves.sites) {
    if (site.status != SiteStatus::Complete) continue;
    sites.push_back(&site);
    vertices.push_back(site.vertex);
  }
  const auto read = [&](std::int32_t vertex) {
    const auto row = std::lower_bound(vertices.begin(), vertices.end(), vertex) - vertices.begin();
    return fields_of(space.fields(), *sites[static_cast<std::size_t>(row)]);
  };
  fitting::CompressSettings settings;
  settings.modes = space.c.deformation.modes;
  const Deformation deformation =
      fitting::compress(body, library, curves.tool, vertices, read, settings);
  write_deformation(space.deformation(), deformation);
  emit(LogLine{"fit", fmt::format("{}: {} skin vertices, {} sites, {} modes that leave out {} "
                                  "(root mean square), {:.1f} MB",
                                  space.deformation().string(), deformation.positions.size(),
                                  deformation.sites.size(), deformation.mode_count(),
                                  length_text(deformation.rms_left_out),
                                  1e-6 * static_cast<double>(fs::file_size(space.deformation())))});
}

}  // namespace palpate::app
