// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/import_account.hpp"

#include "app/json_number.hpp"
#include "format/numbers.hpp"

namespace palpate::app {
namespace {

namespace m = palpate::measured;
using Json = nlohmann::ordered_json;

const char* drift_word(m::DriftState state) {
  switch (state) {
    case m::DriftState::Unknown:
      return "unknown";
    case m::DriftState::Fitted:
      return "removed";
    case m::DriftState::Undetermined:
      return "not determined";
    case m::DriftState::Suspected:
      return "seen, not determined";
  }
  return "";
}

/// Samples are counted from 1.
Json saturation_account(const std::optional<m::Saturation>& saturation) {
  if (!saturation) return nullptr;
  return {{"reading_N", saturation->reading},    {"from_s", json_number(saturation->from)},
          {"to_s", json_number(saturation->to)}, {"first_sample", saturation->first + 1},
          {"last_sample", saturation->last + 1}, {"travel_m", saturation->travel}};
}

Json end_account(const CurvePath& path) {
  const CurveSample& end = path.samples.back();
  return {{"repeats", path.repeats},
          {"contact_uncertainty_m", json_number(path.contact_uncertainty)},
          {"force_N", dot(end.force, path.direction)},
          {"force_scatter_N", json_number(end.force_scatter)},
          {"force_uncertainty_N", json_number(end.force_uncertainty)}};
}

}  // namespace

Json press_account(const std::string& file, const m::CsvTable& table, const PlacedAt& place,
                   const m::PressCurve& curve) {
  const m::Baseline& b = curve.baseline;
  const double returned =
      curve.work_loading > 0 ? curve.work_returned / curve.work_loading : kUnknown;
  return {{"file", file},
          {"vertex", place.vertex},
          {"distance_to_vertex_m", place.distance},
          {"preamble", table.preamble},
          {"cycles", curve.cycles},
          {"cycle", curve.cycle},
          {"contact_m", curve.contact.displacement},
          {"contact_uncertainty_m", curve.contact.uncertainty},
          {"force_offset_N", b.offset},
          {"drift_N_per_s", b.drift},
          {"drift_uncertainty_N_per_s", json_number(b.drift_uncertainty)},
          {"drift", drift_word(b.state)},
          {"drift_not_excluded_N_per_s", json_number(b.possible_drift)},
          {"noise_N", b.noise},
          {"noise_autocorrelation", b.autocorrelation},
          {"rate_m_per_s", json_number(curve.rate)},
          {"deepest_m", curve.loading.back().depth},
          {"largest_force_N", curve.loading.back().force},
          {"work_loading_J", curve.work_loading},
          {"returned_fraction", json_number(returned)},
          {"saturation", saturation_account(curve.saturation)}};
}

Json sites_account(const Curves& curves) {
  Json sites = Json::array();
  for (const SiteCurves& site : curves.sites) {
    const CurvePath& normal = site.paths.front();
    Json account = {{"vertex", site.vertex}, {"depth_m", normal.samples.back().displacement}};
    account.update(end_account(normal));
    Json lateral = Json::array();
    for (std::size_t i = 1; i < site.paths.size(); ++i) {
      const CurvePath& path = site.paths[i];
      Json entry = {{"lateral_depth_m", path.lateral_depth},
                    {"travel_m", path.samples.back().displacement},
                    {"direction", path.direction}};
      entry.update(end_account(path));
      lateral.push_back(entry);
    }
    account["lateral_paths"] = lateral;
    sites.push_back(account);
  }
  return sites;
}

}  // namespace palpate::app
