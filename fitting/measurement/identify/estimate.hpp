// SPDX-License-Identifier: AGPL-3.0-or-later
// Constants of a device from its motion under known forces.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fitting/measurement/identify/motion_record.hpp"
#include "format/numbers.hpp"

namespace palpate::identify {

/// A value with its standard deviation; NaN where it was not determined.
struct Measured {
  double value = kUnknown;
  double deviation = kUnknown;

  /// Bounds on the safe side, two and a half standard deviations away: 99 % of a normal
  /// distribution, and some 97 % where the deviation itself is an estimate from twenty blocks.
  static constexpr double kSafe = 2.5;
  double low() const { return value - kSafe * deviation; }
  double high() const { return value + kSafe * deviation; }
};

/// One axis. `problem`: why nothing is known, with what to do; empty when it is.
struct AxisEstimate {
  std::string problem;
  Measured mass;                    ///< m, kg, effective at the handle
  std::array<Measured, 3> damping;  ///< row of B: forces along this axis by velocities, N s/m
  Measured friction;                ///< S, N
  Measured stiffness;               ///< k, N/m, of hand, springs and cables
  Measured bias;                    ///< g, N: weight and offset
  Measured delay;                   ///< D, s, from a sample to the force that follows it
  double residual = kUnknown;       ///< root mean square of the misfit, N
  double travel = 0;                ///< m, largest distance between two positions
  std::size_t windows = 0;          ///< equations
};

/// Least squares of the weak form of
///   sum_j (m_j a_j + b_j v_j) + S sign(v) + k x + g = f(t - D)
/// over windows of one-way motion, with v along the excited axis and a_j, v_j along all axes that
/// move; D is the delay with the smallest residual. Deviations by the Jacobian at the solution,
/// with the variance of the residuals. Commands are known, whatever computed them.
/// @param largest_delay  s, the search ends there
AxisEstimate estimate_axis(const MotionRecord& record, double largest_delay);

/// sigma_0(B): the smallest eigenvalue of the symmetric part of B, whose rows are the estimates
/// along `axes`; what was not determined is zero beside the diagonal. Its deviation is the root of
/// the sum of the squares of those of all entries, as an eigenvalue moves by at most the Frobenius
/// norm of the error [Weyl 1912].
Measured smallest_damping(const std::vector<std::size_t>& axes,
                          const std::vector<AxisEstimate>& estimates);

/// Upper estimate of the step of the positions along the excited axis, m: the largest distance
/// between the change of the position in a sample and that of the smooth motion, where it is slow.
double position_step(const MotionRecord& record);

}  // namespace palpate::identify
