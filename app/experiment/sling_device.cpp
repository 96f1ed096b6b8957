// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/sling_device.hpp"

#include <cmath>
#include <string>

#include "app/experiment/energy_balance.hpp"
#include "app/experiment/line_of_touch.hpp"
#include "format/error.hpp"
#include "runtime/devices/device_simulated.hpp"

namespace palpate::app {
namespace {

/// Where the force of the band is `force` at the depth at which that of the wall is.
double anchor_of(double band, double force) {
  return force / published::kMargin + slingshot::kCurved / 2 + force / band;
}

/// The mass that hits the wall with the published speed: the kinetic energy is in proportion.
double mass_of(SlingDevice device) {
  for (double ratio = 0; std::abs(ratio - 1) > 1e-6;) {
    const double speed = impact_speed(device) / published::kImpact;
    ratio = speed * speed;
    device.mass *= ratio;
  }
  return device.mass;
}

}  // namespace

double impact_speed(const SlingDevice& device) {
  constexpr double kStep = 1e-4, kLongest = 10;  // s
  runtime::SimulatedDevice handle(
      {device.mass, device.damping, device.friction, device.band, 0, 1});
  handle.place({published::kRelease, 0, 0}, {});
  handle.set_target({device.anchor, 0, 0}, {});
  double x = published::kRelease, v = 0;
  for (double t = 0; t < kLongest; t += kStep) {
    handle.step(kStep, {});
    const double next = handle.position()[0], speed = handle.velocity()[0];
    if (next >= 0) return v + (speed - v) * (0 - x) / (next - x);
    x = next;
    v = speed;
  }
  return 0;
}

SlingDevice fitted_device(double band, double friction) {
  SlingDevice device{0.1, 0, friction, band, anchor_of(band, published::kRestForce)};
  const auto margin = [&device](double damping) {
    device.damping = damping;
    device.mass = mass_of(device);
    return bonded_margin_by_energy_balance(device, published::kRate, 0);
  };
  double low = 1e-3, high = 1;
  if (margin(low) > published::kMargin || margin(high) < published::kMargin)
    throw Error(ErrorKind::Internal, "device of the experiment",
                "no damping gives the published margin with a dry friction of " +
                    std::to_string(friction) + " N",
                "take a smaller dry friction");
  while (high - low > 1e-4 * low) {
    const double middle = (low + high) / 2;
    (margin(middle) > published::kMargin ? high : low) = middle;
  }
  margin((low + high) / 2);
  return device;
}

}  // namespace palpate::app
