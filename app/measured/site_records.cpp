// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/site_records.hpp"

#include <fmt/format.h>

#include <utility>

#include "fitting/measurement/records/batch.hpp"
#include "fitting/measurement/records/repeats.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace m = palpate::measured;

std::string where_of(const SiteRecords& records) {
  return records.name.empty() ? fmt::format("site at vertex {}", records.vertex) : records.name;
}

/// The one press of a site, sample by sample.
CurvePath recorded_press(const SiteRecords& records, const MachineSection& machine) {
  if (records.presses.size() > 1) {
    throw Error(ErrorKind::Configuration, where_of(records),
                fmt::format("{} presses have it as their nearest site, and samples as recorded "
                            "are not averaged",
                            records.presses.size()),
                "give path.samples instead of as_recorded");
  }
  return m::recorded_path(records.presses.front(), records.inward,
                          {stated_or_zero(machine.force_noise), machine.force_calibration,
                           machine.compliance_uncertainty},
                          where_of(records));
}

}  // namespace

SiteCurves site_curves(const SiteRecords& records, const Sidecar& s) {
  const m::RepeatSettings settings{s.path.samples, s.machine.force_calibration,
                                   s.machine.compliance_uncertainty};
  SiteCurves site;
  site.vertex = records.vertex;
  site.status = SiteStatus::Complete;
  site.paths.push_back(s.path.as_recorded ? recorded_press(records, s.machine)
                                          : m::mean_path(records.presses, records.inward, settings,
                                                         where_of(records)));
  if (records.drags.empty() && s.path.lateral_ratio > 0)
    site.paths.push_back(m::lateral_from_normal(site.paths.front(), s.path.lateral_ratio));
  for (CurvePath& path : m::lateral_paths(records.drags, records.inward,
                                          {s.path.lateral_samples, s.machine.force_calibration},
                                          "drags of the " + where_of(records)))
    site.paths.push_back(std::move(path));
  return site;
}

}  // namespace palpate::app
