// SPDX-License-Identifier: AGPL-3.0-or-later
// Constants of any model of the forces of presses, by least squares over measured curves.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fem/campaign/sensitivity.hpp"
#include "fitting/measurement/calibrate/least_squares.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// The constants whose profile likelihood is computed: none, all that are sought, or those whose
/// linearised interval is in doubt, wider than a tenth of the value to either side or correlated
/// beyond 0.95 with another one.
enum class Profiles { None, Doubtful, All };

struct PressFitSettings {
  int depths = 6;      ///< of each measured curve that are compared, evenly spaced
  bool drags = false;  ///< compare measured drags as well
  double confidence = 0.95;
  Profiles profiles = Profiles::Doubtful;
  /// How profiles are made; `of` is chosen by `profiles`.
  calibrate::ProfileSettings profile{.of = {}, .closeness = 0.01, .at_bounds = true};
  std::function<void(const std::string& line)> log;  ///< one line an evaluation; may be empty
};

/// What a model is asked for: the presses of one of the measured curves, by one tool.
struct PressPlan {
  std::size_t set = 0;                                 ///< which of them
  std::vector<std::int32_t> vertices;                  ///< of the sites
  std::vector<double> depths;                          ///< m, ascending
  std::vector<std::vector<fem::LateralPlan>> lateral;  ///< of each site
};

/// The forces of presses as a function of constants.
class PressModel {
 public:
  virtual ~PressModel() = default;

  /// The constants with start and bounds, of all sets alike. Profiles are made of the first
  /// profiled() at most. `plan` is that of the first set.
  virtual std::vector<calibrate::Constant> constants(const PressPlan& plan) const = 0;
  virtual std::size_t profiled(const PressPlan& plan) const = 0;
  /// The constant that all forces are proportional to, whatever the others are. It costs no
  /// evaluation, and the others are sought with it at its best.
  virtual std::optional<std::size_t> modulus() const { return {}; }
  /// More starts beside that of constants(), each a full set; may be empty.
  virtual std::vector<std::vector<double>> starts(const PressPlan&) const { return {}; }

  /// Forces with their slopes by the constants, of each site of the plan; a site with fewer samples
  /// than depths says why. False, with a clause for the log, for constants that make no model.
  virtual bool forces(const PressPlan& plan, const std::vector<double>& at,
                      std::vector<fem::SiteSensitivity>& sites, std::string& refusal) = 0;
};

/// One path as it was fitted.
struct FittedPath {
  std::size_t set = 0;  ///< of the measured curves
  std::int32_t vertex = -1;
  PathKind kind = PathKind::Normal;
  double lateral_depth = 0;                                  ///< m, of a lateral path
  std::vector<double> depth, measured, fitted, uncertainty;  ///< m, N, N, N (NaN unknown)
  double contact_shift = 0;                                  ///< m, found with the constants
};

struct PressFit {
  calibrate::Calibration calibration;  ///< constants of the model; then the contact shifts
  std::vector<FittedPath> paths;
  double rms = 0;               ///< N
  double relative_rms = 0;      ///< over the largest measured force
  int evaluations = 0;          ///< of the model, for the best fit
  int profile_evaluations = 0;  ///< and for the profiles
};

/// Several sets of curves, of several tools, have the same constants: their depths are those of
/// each. Measured drags are compared with lateral paths of the model without slip, at their depth;
/// lateral paths that were made from the normal one are no measurement and left out.
/// Where a measured path states the uncertainty of its contact point, the shift of that point is
/// sought as well, weighted by the stated uncertainty: an error of the contact point acts on all
/// samples of a curve alike and must not be averaged away. On a drag it acts through the depth, as
/// force/(2 depth). Where every sample states its
/// uncertainty the residuals are divided by what the shift leaves of it, and the intervals follow
/// from that; otherwise the scatter is estimated from the residuals. The samples of a path follow
/// each other: where they are missed alike the intervals count it (LeastSquares::series).
/// @param where  names what is calibrated, for messages.
/// @throws Error(Configuration) for a set without a measured normal path; when the model fails at
/// the
///   start.
PressFit fit_presses(std::span<const Curves> measured, PressModel& model,
                     const PressFitSettings& settings, const std::string& where);

}  // namespace palpate::app
