// SPDX-License-Identifier: AGPL-3.0-or-later
// Constants of a device from its motion under known forces.
#pragma once

#include <array>
#include <string>

#include "fitting/measurement/identify/delay_spread.hpp"
#include "fitting/measurement/identify/measured.hpp"
#include "fitting/measurement/identify/motion_record.hpp"

namespace palpate::identify {

/// One axis. `problem`: why nothing is known, with what to do; empty when it is.
struct AxisEstimate {
  std::string problem;
  Measured mass;                    ///< m, kg, effective at the handle
  std::array<Measured, 3> damping;  ///< row of B: forces along this axis by velocities, N s/m
  Measured friction;                ///< S, N
  Measured stiffness;               ///< k, N/m, of hand, springs and cables
  Measured bias;                    ///< g, N: weight and offset
  Measured delay;                   ///< D, s, from a sample to the force that follows it: the mean
  DelaySpread spread;               ///< of the delay around it
  double residual = kUnknown;       ///< root mean square of the misfit, N
  double travel = 0;                ///< m, largest distance between two positions
  std::size_t windows = 0;          ///< equations
};

/// Least squares of the weak form of
///   sum_j (m_j a_j + b_j v_j) + S sign(v) + k x + g = f(t - D)
/// over windows of one-way motion, with v along the excited axis and a_j, v_j along all axes that
/// move, before the first jump of the command; D is the delay with the smallest residual.
/// Deviations by the Jacobian at the solution, with the variance of the residuals. Commands are
/// known, whatever computed them.
/// @param largest_delay  s, the search ends there
AxisEstimate estimate_axis(const MotionRecord& record, double largest_delay);

/// Upper estimate of the step of the positions along the excited axis, m: the largest distance
/// between the change of the position in a sample and that of the smooth motion, where it is slow.
double position_step(const MotionRecord& record);

}  // namespace palpate::identify
