// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/identify/device_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/case/toml_string.hpp"
#include "fitting/measurement/identify/directions.hpp"

namespace palpate::app {
namespace {

std::vector<identify::Directional> each(
    const std::vector<DirectionFinding>& directions,
    const identify::Measured& (*value)(const identify::AxisEstimate&)) {
  std::vector<identify::Directional> found;
  for (const DirectionFinding& d : directions) found.push_back({d.direction, value(d.estimate)});
  return found;
}

const identify::Measured& damping_of(const identify::AxisEstimate& e) {
  return e.damping[0];
}

const identify::Measured& friction_of(const identify::AxisEstimate& e) {
  return e.friction;
}

void enter_damping(const std::vector<DirectionFinding>& directions, DeviceFindings& findings) {
  const identify::Measured smallest = identify::smallest_damping(each(directions, damping_of));
  findings.damping = smallest.value;
  if (smallest.low() > 0) {
    findings.profile.damping = smallest.low();
  } else {
    findings.missing.push_back(
        {"damping", fmt::format("{:.3g} N s/m with a standard deviation of {:.2g} is not certainly "
                                "above zero; measure longer with --seconds, or with more force",
                                smallest.value, smallest.deviation)});
  }
}

void enter_friction(const std::vector<DirectionFinding>& directions, DeviceFindings& findings) {
  const identify::Measured smallest = identify::smallest_friction(each(directions, friction_of));
  findings.profile.coulomb_friction = std::max(0.0, smallest.low());
}

void enter_delay(const std::vector<DirectionFinding>& directions, DeviceFindings& findings) {
  double largest = 0;
  for (const DirectionFinding& d : directions) {
    const double bound = identify::delay_bound(d.estimate.delay, d.estimate.spread, d.longer);
    if (std::isnan(bound)) {
      findings.missing.push_back(
          {"delay", "along " + identify::direction_name(d.direction) +
                        " too few jumps of the force show in the motion to tell how it varies; "
                        "raise --seconds or --max-force"});
      return;
    }
    largest = std::max(largest, bound);
  }
  findings.profile.delay = largest;
}

/// To four digits, down or up: the text is on the safe side, too.
double rounded(double value, double (*toward)(double)) {
  if (!(value > 0)) return value;
  const double last = std::pow(10.0, std::floor(std::log10(value)) - 3);
  return last * toward(value / last);
}

}  // namespace

DeviceFindings combine(const std::vector<DirectionFinding>& directions) {
  DeviceFindings findings;
  findings.profile.position_resolution = 0;
  for (const DirectionFinding& d : directions)
    findings.profile.position_resolution =
        std::max(findings.profile.position_resolution, d.position_step);
  for (const DirectionFinding& d : directions) {
    if (d.estimate.problem.empty()) continue;
    for (const char* constant : {"damping", "dry friction", "delay"})
      findings.missing.push_back(
          {constant, "along " + identify::direction_name(d.direction) + " " + d.estimate.problem});
    return findings;
  }
  enter_damping(directions, findings);
  enter_friction(directions, findings);
  enter_delay(directions, findings);
  return findings;
}

std::string direction_line(const DirectionFinding& found) {
  const identify::AxisEstimate& e = found.estimate;
  const identify::Measured& b = e.damping[0];
  return fmt::format(
      "mass {:.4g} kg, damping {:.4g} +- {:.2g} N s/m, dry friction {:.4g} +- {:.2g} N, delay "
      "{:.3f} +- {:.3f} ms, at most {:.3f} ms in {} dates, positions late by up to {:.3f} ms more, "
      "periods longer by up to {:.3f} ms",
      e.mass.value, b.value, b.deviation, e.friction.value, e.friction.deviation,
      1e3 * e.delay.value, 1e3 * e.delay.deviation, 1e3 * e.spread.latest.value, e.spread.dated,
      1e3 * e.spread.lateness, 1e3 * found.longer);
}

std::string profile_text(const DeviceFindings& findings,
                         const std::vector<DirectionFinding>& directions) {
  const fitting::DeviceProfile& p = findings.profile;
  std::string text =
      "# Measured by palpate identify. The constants are on the safe side: 2.5 standard "
      "deviations below (damping, dry\n# friction) or above (delay) the estimates.\n";
  for (const DirectionFinding& d : directions)
    if (d.estimate.problem.empty())
      text += "# " + identify::direction_name(d.direction) + ": " + direction_line(d) + "\n";
  text +=
      "# coulomb_friction is the smallest along these directions; between them it can be "
      "smaller.\n";
  if (directions.size() < 13) text += "# For a device that moves along these directions only.\n";
  for (const Missing& m : findings.missing)
    text += "# " + m.constant + " is missing: " + m.reason + "\n";
  text += "name = " + toml_string(p.name) + "\n";
  const auto put = [&text](const char* key, double value, const char* unit) {
    if (!std::isnan(value)) text += fmt::format("{} = \"{:.4g} {}\"\n", key, value, unit);
  };
  put("damping", rounded(p.damping, std::floor), "N s/m");
  put("coulomb_friction", rounded(p.coulomb_friction, std::floor), "N");
  put("delay", rounded(p.delay, std::ceil), "s");
  put("position_resolution", rounded(p.position_resolution, std::ceil), "m");
  put("force_resolution", p.force_resolution, "N");
  put("continuous_force", p.continuous_force, "N");
  put("peak_force", p.peak_force, "N");
  return text + "source = " + toml_string(p.source) + "\n";
}

}  // namespace palpate::app
