// SPDX-License-Identifier: AGPL-3.0-or-later
// One response curve from samples of force against displacement.
#pragma once

#include <string>
#include <vector>

#include "format/library.hpp"

namespace palpate::fitting {

struct ForceSample {
  double displacement = 0;  ///< m, > 0
  double force = 0;         ///< N
};

struct CurveFitSettings {
  double relative_tolerance = 0.01;
  double absolute_tolerance = 0.005;  ///< N
  int max_knots = 12;
  bool zero_first_slope = false;  ///< the normal response touches with slope zero
};

struct CurveFit {
  ResponseCurve curve;
  double largest_error = 0;  ///< N, max |fit - sample| of the stored single-precision curve
  double worst_ratio = 0;    ///< max |fit - sample| / max(relative * |sample|, absolute)
};

/// Weight of the penalty on kinks of the slope, relative to a residual of one tolerance.
inline constexpr double kKinkWeight = 1e-3;
/// Weight of uneven slopes, which settles what even kinks leave open.
inline constexpr double kEvenWeight = 1e-5;

/// Slopes of the curve with the given knots nearest to the samples: the minimum over s >= 0 of
///   sum_i ((f(d_i; s) - f_i)/t_i)^2 + kKinkWeight^2 sum_k (q_k hbar_k^2/max t)^2,
/// t_i = max(relative |f_i|, absolute), q_k the jump of the curvature at interior knot k, hbar_k
/// the mean length of its two pieces. The second sum only decides what the samples leave open: with
/// knots at the samples, slopes that alternate about the true ones fit as well, and would pass for
/// stiffness.
std::vector<double> fit_slopes(const std::vector<ForceSample>& samples,
                               const std::vector<double>& knots, const CurveFitSettings& settings);

/// Choose knots and slopes: from one piece, split where that lowers the worst error most, shift
/// knots, until all samples are within tolerance or the knots are used up; then drop knots that are
/// not needed. Each piece holds two samples at least (the first of a normal response may have
/// none). Where the tolerance cannot be met, a knot has to be worth its numbers [Schwarz 1978]:
/// noise is averaged, not followed. Judged on what is stored: knots and slopes rounded to single
/// precision.
/// @param where names the curve in errors. @throws Error(Configuration) for no samples or values
///   that are not finite.
CurveFit fit_curve(std::vector<ForceSample> samples, const CurveFitSettings& settings,
                   const std::string& where);

}  // namespace palpate::fitting
