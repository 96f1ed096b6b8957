// SPDX-License-Identifier: Apache-2.0
// A simulated haptic device with the hand that moves it.
#pragma once

#include "format/vec3.hpp"

namespace palpate::runtime {

struct SimulatedDeviceSettings {
  double mass = 0.1;            ///< m, kg, > 0
  double damping = 0.1;         ///< b, N s/m, per axis
  double coulomb_friction = 0;  ///< S, N, per axis
  double hand_stiffness = 0;    ///< N/m, spring of the hand to its target
  double hand_damping = 0;      ///< N s/m
  int delay_samples = 1;        ///< 0 or 1: samples from the computation of a command to its effect
};

/// A point mass with viscous and dry friction on each axis, connected by a spring and a damper to
/// the moving target of a hand, and driven by the command, constant between samples. With one
/// sample of delay the command that acts during [t_k, t_k + T) is the one computed from x_{k-1}
/// [Mahvash & Hayward 2005, eqs. 3, 4]. The motion between samples is exact (axis_motion.hpp).
///
/// Loop: read position() and velocity(), compute the force, call step(dt, force).
/// step() is noexcept and allocation-free. One thread at a time.
class SimulatedDevice {
 public:
  /// @throws Error(Configuration) naming the constant that is out of range.
  explicit SimulatedDevice(const SimulatedDeviceSettings& settings);

  /// Sets the state and clears the pending command; the target of the hand is at rest at
  /// `position`.
  void place(const Vec3& position, const Vec3& velocity) noexcept;
  /// Sets the target of the hand (m) and its velocity (m/s).
  void set_target(const Vec3& position, const Vec3& velocity) noexcept;
  /// Takes the command computed from the present state (N, on the tool) and advances by dt (s).
  void step(double dt, const Vec3& command) noexcept;

  const Vec3& position() const noexcept { return position_; }  ///< m
  const Vec3& velocity() const noexcept { return velocity_; }  ///< m/s
  const Vec3& target() const noexcept { return target_; }      ///< m
  /// Force of the hand on the device now, N.
  Vec3 hand_force() const noexcept;

 private:
  SimulatedDeviceSettings settings_;
  Vec3 position_{}, velocity_{};
  Vec3 target_{}, target_velocity_{};
  Vec3 pending_{};  ///< computed from the last sample, acts next
};

}  // namespace palpate::runtime
