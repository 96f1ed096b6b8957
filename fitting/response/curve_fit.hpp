// SPDX-License-Identifier: AGPL-3.0-or-later
// One response curve from samples of force against displacement.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "format/library.hpp"

namespace palpate::fitting {

struct ForceSample {
  double displacement = 0;  ///< m, > 0
  double force = 0;         ///< N
  /// N, mean of the force over the displacements from `since` to this one: what was stored in the
  /// body, over the travel. NaN when unknown.
  double mean = std::numeric_limits<double>::quiet_NaN();
  double since = 0;  ///< m, below `displacement`
};

/// Error that is tolerated everywhere on a curve, over its largest force. Light touch, at a tenth
/// of that force and less, is felt most of the time, and a response that is right there takes
/// hardly more knots (docs/fidelity.md).
inline constexpr double kPeakFraction = 0.001;

struct CurveFitSettings {
  double relative_tolerance = 0.01;
  /// N; NaN: kPeakFraction of the largest |force| of the samples
  double absolute_tolerance = std::numeric_limits<double>::quiet_NaN();
  int max_knots = 12;
  bool zero_first_slope = false;  ///< for the normal response, whose slope is zero at touch
};

struct CurveFit {
  ResponseCurve curve;
  double largest_error = 0;  ///< N, max |fit - sample| of the stored single-precision curve
  /// max |fit - force| / max(relative * |force|, absolute) of the samples and the forces between
  double worst_ratio = 0;
};

/// The settings for these samples: the absolute tolerance is a number.
CurveFitSettings settled(CurveFitSettings settings, const std::vector<ForceSample>& samples);

/// The ascending samples, and forces at three places between those whose mean since the sample
/// before is known. They are on the parabola with that mean; from 0 to the first sample, where the
/// force of a round tool is no polynomial, on the power of the displacement with it.
std::vector<ForceSample> with_forces_between(const std::vector<ForceSample>& samples);

/// Weight of the penalty on kinks of the slope, relative to a residual of one tolerance.
inline constexpr double kKinkWeight = 1e-3;
/// Weight of the penalty on uneven slopes, which decides where the kink penalty is indifferent.
inline constexpr double kEvenWeight = 1e-5;

/// Slopes of the curve with the given knots closest to the samples: the minimum over s >= 0 of
///   sum_i ((f(d_i; s) - f_i)/t_i)^2 + kKinkWeight^2 sum_k (q_k hbar_k^2/max t)^2,
/// t_i = max(relative |f_i|, absolute), q_k the jump of the curvature at interior knot k, hbar_k
/// the mean length of its two pieces. The second sum matters only where the samples do not
/// determine the slopes: with knots at the samples, slopes that alternate about the true ones fit
/// equally well and would overestimate the stiffness.
/// @pre the absolute tolerance is a number: see settled.
std::vector<double> fit_slopes(const std::vector<ForceSample>& samples,
                               const std::vector<double>& knots, const CurveFitSettings& settings);

/// Chooses knots and slopes for the samples with the forces between them. From a single piece,
/// pieces are split where that lowers the largest error most, and knots are shifted, until all
/// samples are within tolerance or the knots are used up; then unnecessary knots are removed. Each
/// piece has at least two samples (the first of a normal response may have none). Where the
/// tolerance cannot be met, the number of knots minimises the criterion of [Schwarz 1978], so noise
/// is averaged. Errors are those of the stored curve with knots and slopes rounded to single
/// precision.
/// @param where  name of the curve in errors. @throws Error(Configuration) for no samples or values
///   that are not finite.
CurveFit fit_curve(std::vector<ForceSample> samples, const CurveFitSettings& settings,
                   const std::string& where);

}  // namespace palpate::fitting
