// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounded least squares with what can be said about the result: intervals, correlations, warnings.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate::calibrate {

struct Constant {
  std::string name;
  std::string unit;  ///< "Pa" or "1"
  double start = 0;
  double low = 0, high = 0;  ///< may be infinite
  bool may_vanish = false;   ///< 0 is a value like any other: an interval that holds it is no doubt
  bool logarithm = false;    ///< the values are logarithms of what is named, for messages
  bool linear = false;       ///< the residuals are straight lines over it, whatever the others are
};

struct LeastSquares {
  std::vector<Constant> constants;
  std::size_t residuals = 0;
  /// Residuals r, and the Jacobian J[row * constants + column] when it is not null. False where the
  /// model has no value. One thread at a time.
  std::function<bool(const double* constants, double* r, double* J)> model;
  /// True when each residual is divided by its known standard uncertainty; otherwise the scatter is
  /// estimated from the residuals.
  bool known_scatter = false;
  /// Replaces constants by those of the same model that stand for it, where several sets are the
  /// same; may be empty.
  std::function<void(std::vector<double>& constants)> canonical;
  /// Lengths of runs of residuals that follow each other along a curve, from the first residual on;
  /// what is left is on its own. Empty: residuals are taken for independent.
  std::vector<std::size_t> series;
  /// Relative standard deviations of the noise of the residuals, where these are weighted by
  /// something else than its inverse; empty: alike. The intervals count them.
  std::vector<double> deviations;
  double confidence = 0.95;
  int max_iterations = 200;
  double tolerance = 1e-12;       ///< relative, of the cost
  double step_tolerance = 1e-10;  ///< relative, of the constants
  /// Distance from the best fit that is close enough, in standard errors; 0: as close as the other
  /// tolerances ask for. For models that cost more than digits that noise hides.
  double offset_tolerance = 0;
  /// The linear constants are eliminated first [Golub & Pereyra 1973], not only where a descent in
  /// all constants does not end: for models that cost little at other values of these.
  bool linear_first = false;
};

struct Estimate {
  std::string name, unit;
  double value = 0;
  double standard_error = 0;  ///< NaN at a bound, infinite where the data do not see the constant
  double unit_error = 0;      ///< the same for independent residuals of unit scatter
  double low = 0, high = 0;   ///< of the confidence interval, by Student's t
  bool at_bound = false;
  bool logarithm = false;  ///< as that of its Constant
  /// Ends of the profile likelihood, see add_profiles(); NaN without, infinite where it does not
  /// end.
  double profile_low = std::numeric_limits<double>::quiet_NaN();
  double profile_high = std::numeric_limits<double>::quiet_NaN();
  /// What a profile went through, by ascending values of the constant: the rise of the cost of the
  /// best fit of all others, over the rise at which an interval ends.
  std::vector<std::pair<double, double>> profile{};
};

struct Calibration {
  bool converged = false;
  std::vector<Estimate> estimates;
  std::vector<std::vector<double>> correlation;  ///< NaN for a constant at a bound
  double cost = 0;                               ///< half the sum of squares
  double scatter = 0;    ///< standard deviation of the noise, from the residuals
  bool widened = false;  ///< known scatter, but the residuals say more: the intervals are theirs
  /// Correlation of residuals that follow each other, see CorrelatedNoise; `correlated`: more than
  /// by chance, and the intervals count it, which makes them `correlation_widening` times as wide
  /// at most.
  double lag_one = 0, durbin_watson = 2, autocorrelation = 0;
  bool correlated = false;
  bool beyond_noise = false;  ///< the misfit is smoother than noise, see CorrelatedNoise
  double correlation_widening = 1;
  int freedom = 0;               ///< n - p
  double effective_freedom = 0;  ///< of the scatter: n - p, fewer where residuals are correlated
  int iterations = 0;
  double condition = 1;  ///< of the scaled normal matrix: square root of the ratio of eigenvalues
  std::vector<std::string> warnings;  ///< identifiability, bounds, disagreement with the scatter
};

/// Minimise 1/2 |r|^2 within the bounds by Levenberg-Marquardt. The intervals are those of
/// the linearised model, t sqrt(s^2 (J^T J)^-1); constants at a bound are left out of the matrix
/// and have none. s is the scatter of the residuals; when it is known, 1, unless the residuals
/// scatter by more than chance lets them: then theirs again [Birge 1932]. Warned of: correlations
/// beyond 0.95 (two constants that the data cannot distinguish), an interval wider than the value,
/// a constant at its bound, residuals that a known scatter does not explain. Where residuals that
/// follow each other are alike by more than chance, the covariance is s^2 (J^T J)^-1 J^T V J
/// (J^T J)^-1 with the correlation V that they show, and that is warned of (correlated_noise.hpp).
/// Residuals as many as constants leave the intervals without end.
/// @throws Error(Configuration) naming `where` when there are fewer residuals than constants, a
///   start outside its bounds, no value at the start, or an iteration that does not converge.
Calibration minimise(const LeastSquares& problem, const std::string& where);

/// The best of several starts, each a full set of constants that is moved within the bounds; of
/// equally good ends the earliest, and a warning that names another one. What has not converged
/// does not count. @throws as above; when no start converges, with the best that was reached.
Calibration minimise(LeastSquares problem, const std::vector<std::vector<double>>& starts,
                     const std::string& where);

/// The same, or none where no start converges.
std::optional<Calibration> converged_minimum(LeastSquares problem,
                                             const std::vector<std::vector<double>>& starts,
                                             const std::string& where);

struct ProfileSettings {
  std::vector<std::size_t> of;  ///< indices of the constants; empty: all
  double closeness = 1e-4;      ///< of an end, relative to its distance from the best fit
  int between = 0;              ///< fits between the best one and each end, for a picture
  bool at_bounds = false;       ///< also one-sided profiles of constants at a bound
};

/// Intervals that do not linearise: of each constant the values at which the best fit of all others
/// is worse than the best fit by no more than chance allows,
///   2 (cost(value) - cost) <= t^2 s^2, s and t those of the linearised intervals,
/// found by fits at fixed values of the constant [Bates & Watts 1988, sec. 6.1]; times what
/// correlated residuals add to the variance of the constant. They end at the bounds of the
/// constant. Constants at a bound get none, or with at_bounds a profile to the other side, at the
/// rise that the other constants have in the mean. Warned of: a profile that does not end, or only
/// where the model has no value, one that is far from its linearised interval, one that meets a
/// better fit. The square root of the cost is followed, which is linear where the problem is: a few
/// fits an end.
void add_profiles(const LeastSquares& problem, Calibration& result,
                  const ProfileSettings& settings = {});

}  // namespace palpate::calibrate
