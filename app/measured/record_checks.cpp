// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/record_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/to_index.hpp"

namespace palpate::app {
namespace {

namespace m = palpate::measured;

/// The depth of a press is hardly ever so many radii of its tool.
constexpr double kManyRadii = 10;

double extent_of(const Body& body) {
  Vec3 low = body.nodes.front(), high = low;
  for (const Vec3& x : body.nodes) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], x[i]);
      high[i] = std::max(high[i], x[i]);
    }
  }
  return norm(high - low);
}

/// "from 1.2 s to 2.3 s (samples 61 to 116) the force stays at exactly 0.5 N while ...".
std::string saturation_text(const m::Saturation& s) {
  const std::string samples = fmt::format("samples {} to {}", s.first + 1, s.last + 1);
  const std::string span =
      std::isnan(s.from) ? "in the " + samples
                         : fmt::format("from {:.5g} s to {:.5g} s ({})", s.from, s.to, samples);
  return fmt::format("{} the force stays at exactly {} while the tool goes on by {}", span,
                     force_text(std::abs(s.reading)), length_text(s.travel));
}

}  // namespace

double tolerance_on(const Body& body, double tool_radius) {
  constexpr double kMost = 5e-3, kRadii = 4;
  double sum = 0;
  const auto corner = [&](std::int32_t v) {
    return body.nodes[to_index(body.response.node[to_index(v)])];
  };
  for (const Triangle& t : body.response.triangles)
    for (std::size_t i = 0; i < 3; ++i) sum += norm(corner(t[i]) - corner(t[(i + 1) % 3]));
  const double edge = sum / (3 * static_cast<double>(body.response.triangles.size()));
  return std::min(kMost, std::max(edge, kRadii * tool_radius));
}

RecordChecks::RecordChecks(const Sidecar& sidecar, const std::optional<Body>& body)
    : tool_radius_(sidecar.tool.radius), path_(sidecar.path) {
  check_stated(sidecar);
  if (!body) return;
  extent_ = extent_of(*body);
  if (tool_radius_ <= *extent_) return;
  warn(fmt::format("the radius of the tool, {}, is larger than the body, {}: check its unit",
                   length_text(tool_radius_), length_text(*extent_)));
}

void RecordChecks::check_stated(const Sidecar& s) {
  if (s.presses.empty() && s.robot_logs.empty() && s.batches.empty()) return;
  std::vector<std::string> missing;
  if (s.contact.method == "given" && std::isnan(s.contact.position_uncertainty))
    missing.push_back("contact.position_uncertainty");
  if (s.baseline.method == "zeroed" && std::isnan(s.baseline.uncertainty))
    missing.push_back("baseline.uncertainty");
  if (s.path.as_recorded && std::isnan(s.machine.force_noise))
    missing.push_back("machine.force_noise");
  if (missing.empty()) return;
  warn(fmt::format("the uncertainties of the forces count what is not stated as zero: give {}",
                   fmt::join(missing, ", ")));
}

void RecordChecks::check_depth(const std::string& where, const m::PressCurve& curve) {
  const double depth = curve.loading.back().depth;
  if (extent_ && depth > *extent_) {
    throw Error(ErrorKind::Configuration, where,
                fmt::format("the tool goes {} deep into a body of {}", length_text(depth),
                            length_text(*extent_)),
                "check the unit of the displacement");
  }
  if (depth > kManyRadii * tool_radius_) {
    warn(fmt::format("{}: the tool goes {} deep, its radius is {}: check the units", where,
                     length_text(depth), length_text(tool_radius_)));
  }
}

void RecordChecks::check_stiffness(const std::string& where, const m::PressCurve& curve) {
  constexpr double kSoftest = 10, kStiffest = 10e6;  // Pa
  const m::DepthForce& end = curve.loading.back();
  if (end.depth > kManyRadii * tool_radius_) return;  // the depth is in doubt already
  // E* of a half-space under a sphere [Hertz 1881].
  const double modulus = 0.75 * end.force / std::sqrt(tool_radius_ * std::pow(end.depth, 3));
  if (!(modulus > 0) || (modulus >= kSoftest && modulus <= kStiffest)) return;
  warn(
      fmt::format("{}: {} at {} is the force of a half-space of {:.2g} Pa: check the units of "
                  "force and displacement",
                  where, force_text(end.force), length_text(end.depth), modulus));
}

void RecordChecks::check_range(const std::string& where, const m::PressCurve& curve) {
  if (!curve.saturation) return;
  warn(
      fmt::format("{}: {}: the load cell is at its limit, or the force was held; the curve ends "
                  "before. Measure within the range of the load cell",
                  where, saturation_text(*curve.saturation)));
}

void RecordChecks::check_range(const std::string& where, const m::History& history) {
  if (!history.saturation || history.control == m::Control::Force) return;
  warn(
      fmt::format("{}: {}: the load cell is at its limit; the record is kept whole, with these "
                  "samples: leave it out, or measure within the range of the load cell",
                  where, saturation_text(*history.saturation)));
}

void RecordChecks::check_drift(const std::string& where, const m::PressCurve& curve) {
  constexpr double kMatters = 0.05;  // of the force
  const m::DepthForce& end = curve.loading.back();
  if (curve.baseline.state == m::DriftState::Suspected) {
    const double at_end = curve.common.suspected_drift * (end.time - curve.common.suspected_from);
    warn(
        fmt::format("{}: out of contact the force drifts, by {} until the deepest point, if it "
                    "goes on; too few samples determine it: it is not removed, and counts as an "
                    "uncertainty. Record the release, or a wait before the press, and the time",
                    where, force_text(std::abs(at_end))));
  } else if (curve.baseline.possible_drift * end.time > kMatters * std::abs(end.force)) {
    warn(
        fmt::format("{}: the samples out of contact do not exclude a drift of {} until the "
                    "deepest point, {} of the force; none is removed, and the uncertainty has "
                    "none. Record the release, or a wait before the press",
                    where, force_text(curve.baseline.possible_drift * end.time),
                    percent_text(curve.baseline.possible_drift * end.time / end.force)));
  }
}

void RecordChecks::check_lateral(const std::string& where, const m::BatchSite& site) {
  constexpr double kMuch = 0.25;
  if (site.lateral_fraction > kMuch) {
    warn(
        fmt::format("{}: {} of the normal force acts across the normal at the deepest point, "
                    "and is in no curve: check the normal",
                    where, percent_text(site.lateral_fraction)));
  }
  const double depth = site.press.loading.back().depth;
  if (site.sideways > kMuch * depth) {
    warn(fmt::format("{}: the tool moves {} across the normal, and {} along it", where,
                     length_text(site.sideways), length_text(depth)));
  }
}

void RecordChecks::check_force(const SiteCurves& site) {
  for (const CurvePath& path : site.paths) {
    const CurveSample& end = path.samples.back();
    if (!(end.force_uncertainty > 0.5 * std::abs(dot(end.force, path.direction)))) continue;
    warn(fmt::format("site {}: the force is uncertain by more than half of itself", site.vertex));
    return;
  }
}

void RecordChecks::check_samples(const SiteCurves& site) {
  const std::size_t samples = site.paths.front().samples.size() - 1;  // less the touch
  if (path_.as_recorded || samples >= static_cast<std::size_t>(path_.samples)) return;
  warn(
      fmt::format("site {}: its curve has {} samples instead of {}: its records are coarse, or "
                  "begin in contact (path.as_recorded = true keeps every sample of a press)",
                  site.vertex, samples, path_.samples));
}

}  // namespace palpate::app
