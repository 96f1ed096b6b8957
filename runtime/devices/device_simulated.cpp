// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/device_simulated.hpp"

#include <cmath>
#include <cstddef>
#include <string>

#include "runtime/devices/axis_motion.hpp"
#include "runtime/settings_check.hpp"

namespace palpate::runtime {

SimulatedDevice::SimulatedDevice(const SimulatedDeviceSettings& settings) : settings_(settings) {
  const SettingsCheck require("simulated device");
  const auto require_not_negative = [&require](const char* what, double value) {
    require(std::isfinite(value) && value >= 0, what, value, "a finite value, 0 or more");
  };
  require(std::isfinite(settings.mass) && settings.mass > 0, "mass (kg)", settings.mass,
          "a finite value above 0");
  require_not_negative("damping (N s/m)", settings.damping);
  require_not_negative("coulomb_friction (N)", settings.coulomb_friction);
  require_not_negative("hand_stiffness (N/m)", settings.hand_stiffness);
  require_not_negative("hand_damping (N s/m)", settings.hand_damping);
  require(settings.delay_samples == 0 || settings.delay_samples == 1, "delay_samples",
          settings.delay_samples, "0 or 1");
}

void SimulatedDevice::place(const Vec3& position, const Vec3& velocity) noexcept {
  position_ = target_ = position;
  velocity_ = velocity;
  target_velocity_ = pending_ = {};
}

void SimulatedDevice::set_target(const Vec3& position, const Vec3& velocity) noexcept {
  target_ = position;
  target_velocity_ = velocity;
}

void SimulatedDevice::step(double dt, const Vec3& command) noexcept {
  const Vec3 acting = settings_.delay_samples == 0 ? command : pending_;
  pending_ = command;
  for (std::size_t i = 0; i < 3; ++i) {
    const AxisLaw law{settings_.mass,
                      settings_.damping,
                      settings_.coulomb_friction,
                      settings_.hand_stiffness,
                      settings_.hand_damping,
                      acting[i],
                      target_[i],
                      target_velocity_[i]};
    const AxisState after = advance(law, {position_[i], velocity_[i]}, dt);
    position_[i] = after.position;
    velocity_[i] = after.velocity;
    target_[i] += target_velocity_[i] * dt;
  }
}

Vec3 SimulatedDevice::hand_force() const noexcept {
  return settings_.hand_stiffness * (target_ - position_) +
         settings_.hand_damping * (target_velocity_ - velocity_);
}

}  // namespace palpate::runtime
