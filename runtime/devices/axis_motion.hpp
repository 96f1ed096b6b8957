// SPDX-License-Identifier: Apache-2.0
// One axis of a simulated device between two samples, solved in closed form.
#pragma once

namespace palpate::runtime {

/// A mass on one axis with viscous and dry friction, a constant force, and a spring-damper to a
/// target that moves at constant velocity:
///   m x'' = F - b x' - S sign(x') + k (p + p' t - x) + b_h (p' - x')
struct AxisLaw {
  double mass = 0;              ///< m, kg, > 0
  double damping = 0;           ///< b, N s/m
  double coulomb_friction = 0;  ///< S, N
  double hand_stiffness = 0;    ///< k, N/m
  double hand_damping = 0;      ///< b_h, N s/m
  double force = 0;             ///< F, N
  double target = 0;            ///< p at t = 0, m
  double target_velocity = 0;   ///< p', m/s
};

struct AxisState {
  double position = 0;  ///< m
  double velocity = 0;  ///< m/s
};

/// The state after dt (s). Between changes of sign of the velocity the equation is linear and its
/// solution has a closed form; the instants of stopping and of breaking away are found to rounding
/// (the velocity is monotone between the zeros of the acceleration, which have a closed form). No
/// step-size error, hence no energy of the integrator. noexcept, allocation-free, bounded.
AxisState advance(const AxisLaw& law, const AxisState& start, double dt) noexcept;

}  // namespace palpate::runtime
