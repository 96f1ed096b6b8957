// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/batch.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fitting/measurement/records/repeats.hpp"
#include "format/error.hpp"

namespace palpate::measured {
namespace {

constexpr double kUnitWithin = 0.01;
constexpr double kSameNormal = 1e-3;  ///< of unit vectors, within a site
constexpr double kSamePoint = 1e-5;   ///< m, of the contact point within a site

using Rows = std::vector<std::size_t>;

std::string site_name(long number) {
  return "site " + std::to_string(number);
}

/// What no site fulfils is hardly the fault of a site.
[[noreturn]] void refuse_all(const std::vector<RefusedSite>& refused) {
  const Error& first = refused.front().reason;
  if (refused.size() == 1) throw first;
  refuse(first.where(),
         first.problem() + "; none of the " + std::to_string(refused.size()) +
             " sites can be used, this is the first",
         first.remedy());
}

void check_columns(const BatchLog& log) {
  const std::size_t rows = log.site.size();
  const bool same = log.outward.size() == rows && log.position.size() == rows &&
                    log.force.size() == rows && (log.time.empty() || log.time.size() == rows) &&
                    (log.contact.empty() || log.contact.size() == rows) &&
                    (log.readings.empty() || log.readings.size() == rows);
  if (!same) refuse(log.name, "its columns have different lengths", "give one value per row");
  if (rows == 0) refuse(log.name, "it has no rows", "copy or record it again");
}

/// The rows of each site, in order of the record.
std::map<long, Rows> rows_by_site(const BatchLog& log) {
  std::map<long, Rows> sites;
  for (std::size_t row = 0; row < log.site.size(); ++row) {
    const double number = log.site[row];
    if (!(std::abs(number) < 1e9) || number != std::round(number)) {
      refuse(log.name, "row " + std::to_string(row + 1) + ": its site is no whole number",
             "number the sites");
    }
    sites[static_cast<long>(number)].push_back(row);
  }
  return sites;
}

void leave_out(std::map<long, Rows>& sites, const BatchLog& log,
               const std::vector<std::string>& numbers) {
  for (const std::string& number : numbers) {
    const auto found = std::find_if(sites.begin(), sites.end(), [&](const auto& site) {
      return std::to_string(site.first) == number;
    });
    if (found == sites.end())
      refuse(log.name, "it has no site '" + number + "' to leave out", "name a site of the record");
    sites.erase(found);
  }
  if (sites.empty()) refuse(log.name, "no site is left", "leave out fewer");
}

/// The value that all rows of a site state.
Vec3 common_value(const std::vector<Vec3>& column, const Rows& rows, double tolerance,
                  const std::string& where, const char* what) {
  const Vec3 value = column[rows.front()];
  for (const std::size_t row : rows) {
    if (norm(column[row] - value) <= tolerance) continue;
    refuse(where, std::string("its ") + what + " changes from row to row",
           "give each press a site number of its own");
  }
  return value;
}

void check_finite(const BatchLog& log, const Rows& rows, const std::string& where) {
  for (const std::size_t row : rows) {
    const bool finite = is_finite(log.outward[row]) && is_finite(log.position[row]) &&
                        is_finite(log.force[row]) &&
                        (log.contact.empty() || is_finite(log.contact[row])) &&
                        (log.time.empty() || std::isfinite(log.time[row]));
    if (finite) continue;
    refuse(where, "row " + std::to_string(row + 1) + " has a value that is not finite",
           "mend the record, or leave the site out");
  }
}

Vec3 outward_of(const BatchLog& log, const Rows& rows, const std::string& where) {
  const Vec3 outward = common_value(log.outward, rows, kSameNormal, where, "normal");
  if (std::abs(norm(outward) - 1) < kUnitWithin) return (1 / norm(outward)) * outward;
  refuse(where, "its normal has the length " + std::to_string(norm(outward)) + ", not 1",
         "check the columns of the normal");
}

BatchSite site_of(const BatchLog& log, const Rows& rows, const std::string& name,
                  const BatchSettings& settings) {
  const std::string where = log.name + ", " + name;
  check_finite(log, rows, where);
  BatchSite site;
  site.name = name;
  site.outward = outward_of(log, rows, where);
  const Vec3 inward = -site.outward;
  const bool given = !log.contact.empty();
  const Vec3 origin =
      given ? common_value(log.contact, rows, kSamePoint, where, "contact point") : Vec3{};
  PressRecord record{where, {}, {}, {}, {}};
  for (const std::size_t row : rows) {
    if (!log.time.empty()) record.time.push_back(log.time[row]);
    record.displacement.push_back(dot(log.position[row] - origin, inward));
    record.force.push_back(dot(log.force[row], inward));
  }
  for (std::size_t axis = 0; axis < 3 && !log.readings.empty(); ++axis) {
    std::vector<double>& channel = record.channels.emplace_back();
    for (const std::size_t row : rows) channel.push_back(log.readings[row][axis]);
  }
  const auto deepest = static_cast<std::size_t>(
      std::max_element(record.displacement.begin(), record.displacement.end()) -
      record.displacement.begin());
  if (given && !(record.displacement[deepest] > 0)) {
    refuse(where, "the tool moves out of the body along its normal",
           "check the sign of the normals: they point out of the body");
  }
  if (!(record.force[deepest] > 0)) {
    refuse(where, "the force points out of the body where the tool is deepest",
           "check placement.force_is: \"on body\" or \"on tool\"");
  }
  site.press = analyse_press(record, settings.press);

  const Vec3 end = log.force[rows[deepest]];
  site.lateral_fraction = norm(end - dot(end, inward) * inward) / dot(end, inward);
  const Vec3 start = given ? origin : log.position[rows.front()];
  for (const std::size_t row : rows) {
    const Vec3 moved = log.position[row] - start;
    site.sideways = std::max(site.sideways, norm(moved - dot(moved, inward) * inward));
  }
  const double travel = site.press.contact.displacement - dot(start - origin, inward);
  site.contact = start + (travel + log.position_to_skin) * inward;
  return site;
}

}  // namespace

Batch split_batch(const BatchLog& log, const BatchSettings& settings) {
  check_columns(log);
  std::map<long, Rows> sites = rows_by_site(log);
  leave_out(sites, log, settings.leave_out);
  Batch batch;
  for (const auto& [number, rows] : sites) {
    const std::string name = site_name(number);
    try {
      BatchSite site = site_of(log, rows, name, settings);
      if (settings.check) settings.check(site, log.name + ", " + name);
      batch.sites.push_back(std::move(site));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Configuration) throw;
      batch.refused.push_back({name, error});
    }
  }
  if (batch.sites.empty()) refuse_all(batch.refused);
  return batch;
}

CurvePath recorded_path(const PressCurve& press, const Vec3& inward,
                        const RecordedPathSettings& settings, const std::string& where) {
  CurvePath path;
  path.kind = PathKind::Normal;
  path.direction = inward;
  path.repeats = 1;
  path.contact_uncertainty = press.contact.uncertainty;
  path.samples.push_back(measured_sample());
  path.samples.back().force_uncertainty = 0;
  double work = 0;
  DepthForce before{};
  for (const DepthForce& now : press.loading) {
    if (now.depth == 0) continue;  // the touch
    if (!(now.depth > before.depth)) {
      refuse(where,
             "at " + std::to_string(1e3 * now.depth) +
                 " mm the depth does not increase to the "
                 "next sample",
             "give path.samples instead of as_recorded: the samples are then averaged");
    }
    const double step = now.depth - before.depth, slope = (now.force - before.force) / step;
    const double calibration = settings.force_calibration * now.force;
    const double compliance = slope * now.force * settings.compliance_uncertainty;
    CurveSample sample = measured_sample();
    sample.displacement = now.depth;
    sample.force = now.force * inward;
    work += 0.5 * (now.force + before.force) * step;
    sample.tool_work = work;
    sample.force_uncertainty = std::sqrt(settings.force_noise * settings.force_noise +
                                         press.common.variance(now.time, slope) +
                                         calibration * calibration + compliance * compliance);
    path.samples.push_back(sample);
    before = now;
  }
  return path;
}

}  // namespace palpate::measured
