// SPDX-License-Identifier: AGPL-3.0-or-later
// The device and the rubber band of the published experiment.
#pragma once

namespace palpate::app {

/// What Mahvash & Hayward 2005, VI-B, state of device and band.
namespace published {
inline constexpr double kRelease = -0.03;    ///< m, where the handle is released at rest
inline constexpr double kImpact = 1;         ///< m/s, at which it hits the wall
inline constexpr double kRestForce = 1;      ///< N, "around 1 N": band and wall balance
inline constexpr double kMargin = 170;       ///< N/m, of the wall
inline constexpr double kRate = 2000;        ///< Hz, of the force
inline constexpr double kSearchRate = 100;   ///< Hz
inline constexpr double kAtRest = 168;       ///< N/m, figure 12 (a)
inline constexpr double kOscillating = 179;  ///< N/m, figure 12 (b)
}  // namespace published

/// A point mass on a line, with viscous and dry friction, pulled by a linear band. The paper gives
/// none of the five constants. The default is fitted_device(20 N/m, 0.01 N), rounded.
struct SlingDevice {
  double mass = 0.0845;    ///< kg
  double damping = 0.081;  ///< N s/m
  double friction = 0.01;  ///< N, dry
  double band = 20;        ///< N/m
  double anchor = 0.0584;  ///< m, inside the body: where the band is slack
};

/// The speed at x = 0 after the release at rest, m/s.
double impact_speed(const SlingDevice& device);

/// The device that agrees with the publication, for a stiffness of the band (N/m) and a dry
/// friction (N), which it does not determine: the anchor by the force at rest in the wall of the
/// published margin, the mass by the speed of impact, and the damping by the margin of the wall
/// (bonded_margin_by_energy_balance), to 1e-4 each.
/// @throws Error(Internal) where there is none with a damping between 0.001 and 1 N s/m.
SlingDevice fitted_device(double band, double friction);

}  // namespace palpate::app
