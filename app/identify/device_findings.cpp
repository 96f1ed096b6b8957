// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/identify/device_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/case/toml_string.hpp"

namespace palpate::app {
namespace {

void enter_damping(const std::vector<AxisFinding>& axes, DeviceFindings& findings) {
  std::vector<std::size_t> order;
  std::vector<identify::AxisEstimate> estimates;
  for (const AxisFinding& a : axes) {
    order.push_back(a.axis);
    estimates.push_back(a.estimate);
  }
  const identify::Measured smallest = identify::smallest_damping(order, estimates);
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

/// To four digits, down or up: the text is on the safe side, too.
double rounded(double value, double (*toward)(double)) {
  if (!(value > 0)) return value;
  const double last = std::pow(10.0, std::floor(std::log10(value)) - 3);
  return last * toward(value / last);
}

}  // namespace

std::string axis_name(std::size_t axis) {
  return std::string(1, static_cast<char>('x' + axis));
}

DeviceFindings combine(const std::vector<AxisFinding>& axes) {
  DeviceFindings findings;
  fitting::DeviceProfile& p = findings.profile;
  p.position_resolution = 0;
  for (const AxisFinding& a : axes)
    p.position_resolution = std::max(p.position_resolution, a.position_step);
  for (const AxisFinding& a : axes) {
    if (a.estimate.problem.empty()) continue;
    for (const char* constant : {"damping", "dry friction", "delay"})
      findings.missing.push_back(
          {constant, "along " + axis_name(a.axis) + " " + a.estimate.problem});
    return findings;
  }
  enter_damping(axes, findings);
  p.coulomb_friction = kInfinity;
  p.delay = 0;
  for (const AxisFinding& a : axes) {
    p.coulomb_friction = std::min(p.coulomb_friction, std::max(0.0, a.estimate.friction.low()));
    p.delay = std::max(p.delay, a.estimate.delay.high());
  }
  return findings;
}

std::string profile_text(const DeviceFindings& findings, const std::vector<AxisFinding>& axes) {
  const fitting::DeviceProfile& p = findings.profile;
  std::string text =
      "# Measured by palpate identify. The constants are on the safe side: 2.5 standard "
      "deviations below (damping, dry\n# friction) or above (delay) the estimates.\n";
  for (const AxisFinding& a : axes) {
    const identify::AxisEstimate& e = a.estimate;
    if (!e.problem.empty()) continue;
    const identify::Measured& b = e.damping[a.axis];
    text += fmt::format(
        "# {}: mass {:.4g} kg, damping {:.4g} +- {:.2g} N s/m, dry friction {:.4g} +- {:.2g} N, "
        "delay "
        "{:.3f} +- {:.3f} ms\n",
        axis_name(a.axis), e.mass.value, b.value, b.deviation, e.friction.value,
        e.friction.deviation, 1e3 * e.delay.value, 1e3 * e.delay.deviation);
  }
  text +=
      "# coulomb_friction supposes that dry friction acts along x, y and z; where it acts in "
      "joints "
      "between them, it can be smaller.\n";
  if (axes.size() < 3) text += "# For a device that moves along these axes only.\n";
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
