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

double damping_time(double period, double delay) noexcept {
  return delay <= period ? 1.5 * period + std::sqrt(delay * period) : 1.75 * period + delay;
}

double certifiable_stiffness(const DeviceConstants& device, double rate) noexcept {
  return device.damping / damping_time(1 / rate, device.delay);
}

double certifiable_stiffness_by_friction(const DeviceConstants& device) noexcept {
  const double left = device.coulomb_friction / kErrorPerStep - device.force_resolution;
  if (device.position_resolution == 0) return left < 0 ? -kInfinity : left + kInfinity;
  return left / device.position_resolution;
}

double lowest_rate(const DeviceConstants& device, double lipschitz_bound) noexcept {
  const double longest = device.damping / lipschitz_bound;  // D
  const double tau = device.delay;
  if (std::isnan(longest) || std::isnan(tau)) return kUnknown;
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

PassivityVerdict judge_passivity(const DeviceConstants& device, double lipschitz_bound,
                                 double rate) {
  PassivityVerdict verdict;
  verdict.unknown = unknown_constants(device);
  const double needed = lipschitz_bound * damping_time(1 / rate, device.delay);
  verdict.by_damping = kExact * device.damping >= needed;
  const double error =
      kErrorPerStep * (lipschitz_bound * device.position_resolution + device.force_resolution);
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
