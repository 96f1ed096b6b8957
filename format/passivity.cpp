// SPDX-License-Identifier: Apache-2.0
#include "format/passivity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace palpate {
namespace {

// The error of a position rounded along three axes is at most sqrt(3)/2 of a step.
constexpr double kErrorPerStep = 0.8660254037844386;
// Both sides of a condition are results of a few roundings.
constexpr double kExact = 1 + 1e-12;

}  // namespace

double damping_time(double period, double delay, double relaxation_rate) noexcept {
  const double elastic =
      delay <= period ? 1.5 * period + std::sqrt(delay * period) : 1.75 * period + delay;
  return elastic + relaxation_rate * (period + delay) * (period + delay / 2);
}

double certifiable_stiffness(const DeviceConstants& device, double rate,
                             double relaxation_rate) noexcept {
  return device.damping / damping_time(1 / rate, device.delay, relaxation_rate);
}

double certifiable_stiffness_by_friction(const DeviceConstants& device) noexcept {
  const double left = device.coulomb_friction / kErrorPerStep - device.force_resolution;
  if (device.position_resolution == 0) return left < 0 ? -kInfinity : left + kInfinity;
  return left / device.position_resolution;
}

namespace {

/// The longest period with damping_time() <= longest, s; 0: none. The time grows with the period.
double longest_period(double longest, double delay, double relaxation_rate) noexcept {
  double low = 0, high = longest;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = low + (high - low) / 2;
    if (middle == low || middle == high) break;
    (damping_time(middle, delay, relaxation_rate) <= longest ? low : high) = middle;
  }
  return low;
}

}  // namespace

double lowest_rate(const DeviceConstants& device, const RenderedForce& force) noexcept {
  const double longest = device.damping / force.lipschitz_bound;  // D
  const double tau = device.delay;
  if (std::isnan(longest) || std::isnan(tau)) return kUnknown;
  if (force.relaxation_rate > 0) {
    const bool any = damping_time(0, tau, force.relaxation_rate) < longest;
    return any ? 1 / longest_period(longest, tau, force.relaxation_rate) : kInfinity;
  }
  if (longest >= 2.75 * tau) {  // then D(T) is reached at some T >= tau, and never below it
    const double root = (std::sqrt(tau + 6 * longest) - std::sqrt(tau)) / 3;  // of T
    return 1 / (root * root);
  }
  return longest > tau ? 1.75 / (longest - tau) : kInfinity;
}

double published_rate(double damping, double lipschitz_bound) noexcept {
  return 2 * lipschitz_bound / damping;
}

double largest_position_step(const DeviceConstants& device, double lipschitz_bound) noexcept {
  const double left = device.coulomb_friction / kErrorPerStep - device.force_resolution;
  return std::isnan(left) ? kUnknown : std::max(left, 0.0) / lipschitz_bound;
}

std::vector<std::string> unknown_constants(const DeviceConstants& device) {
  const std::pair<const char*, double> constants[] = {
      {"damping", device.damping},
      {"delay", device.delay},
      {"dry friction", device.coulomb_friction},
      {"position resolution", device.position_resolution},
      {"force resolution", device.force_resolution}};
  std::vector<std::string> unknown;
  for (const auto& [name, value] : constants)
    if (std::isnan(value)) unknown.emplace_back(name);
  return unknown;
}

PassivityVerdict judge_passivity(const DeviceConstants& device, const RenderedForce& force,
                                 double rate) {
  PassivityVerdict verdict;
  verdict.unknown = unknown_constants(device);
  const double needed =
      force.lipschitz_bound * damping_time(1 / rate, device.delay, force.relaxation_rate);
  verdict.by_damping = kExact * device.damping >= needed;
  const double error = kErrorPerStep * (force.lipschitz_bound * device.position_resolution +
                                        device.force_resolution);
  verdict.by_friction = kExact * device.coulomb_friction >= error;
  return verdict;
}

std::string list_in_words(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace palpate
