// SPDX-License-Identifier: Apache-2.0
// When the sampled force loop is passive on a device: docs/theory-certificate.md.
#pragma once

#include <string>
#include <vector>

#include "format/numbers.hpp"

namespace palpate {

/// What the conditions of passivity require of a device. NaN: unknown.
struct DeviceConstants {
  double damping = kUnknown;              ///< sigma_0(B), N s/m: smallest viscous damping
  double coulomb_friction = kUnknown;     ///< sigma_0(S), N: smallest dry friction
  double delay = kUnknown;                ///< tau, s: beyond the sample of delay of the loop
  double position_resolution = kUnknown;  ///< q, m: step of the reported position along an axis
  double force_resolution = kUnknown;     ///< r, N: step of the force along an axis
};

/// What the conditions of passivity require of the force.
struct RenderedForce {
  double lipschitz_bound = kInfinity;  ///< L, N/m
  double relaxation_rate = kInfinity;  ///< K of (C9), 1/s; 0: elastic
};

/// Time D in the condition sigma_0(B) >= L D of [theory-certificate, (C7) and (C9)], s:
///   D = 3/2 T + sqrt(tau T) for tau <= T,   7/4 T + tau beyond,   + K (T + tau)(T + tau/2).
/// It includes the sample of delay of the loop. Grows with T.
/// @param period  T, s, the longest; @param delay  tau, s; @param relaxation_rate  K, 1/s
double damping_time(double period, double delay, double relaxation_rate) noexcept;

/// Largest Lipschitz bound of the force that the damping certifies at a rate (Hz), N/m:
/// sigma_0(B)/D, (C7). NaN where damping or delay is unknown.
double certifiable_stiffness(const DeviceConstants& device, double rate,
                             double relaxation_rate) noexcept;

/// The same by dry friction, at any rate, N/m: (2 sigma_0(S)/sqrt(3) - r)/q, (C8). Infinite where
/// steps are zero, negative where the steps of the force alone are too large; NaN: unknown.
double certifiable_stiffness_by_friction(const DeviceConstants& device) noexcept;

/// Rate from which on (C7) holds, Hz. Infinite: at no rate; NaN: damping or delay is unknown.
double lowest_rate(const DeviceConstants& device, const RenderedForce& force) noexcept;

/// 2 L/sigma_0(B), Hz: the rate of [Mahvash & Hayward 2005, eq. 5], which also needs their (6).
double published_rate(double damping, double lipschitz_bound) noexcept;

/// Largest step of the position that dry friction certifies, m: (2 sigma_0(S)/sqrt(3) - r)/L, not
/// below 0, (C8). NaN: unknown.
double largest_position_step(const DeviceConstants& device, double lipschitz_bound) noexcept;

/// Outcome of both conditions for a force at a rate.
struct PassivityVerdict {
  bool by_damping = false;           ///< (C7) is known to hold
  bool by_friction = false;          ///< (C8) is known to hold
  std::vector<std::string> unknown;  ///< constants of the device that are not known, in words
  bool certified() const noexcept { return by_damping && by_friction; }
};

/// Certified only where every constant is known and both conditions hold.
PassivityVerdict judge_passivity(const DeviceConstants& device, const RenderedForce& force,
                                 double rate);

/// Constants that are not known, in words: "damping", "delay", ...
std::vector<std::string> unknown_constants(const DeviceConstants& device);

/// "delay", "delay and dry friction", "damping, delay and dry friction"
std::string list_in_words(const std::vector<std::string>& words);

}  // namespace palpate
