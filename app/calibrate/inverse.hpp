// SPDX-License-Identifier: AGPL-3.0-or-later
// Constants of the regions of a body from indentation curves measured on it: least squares over the
// finite element model, with the gradients of fem/sensitivity.hpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fem/campaign/sensitivity.hpp"
#include "fitting/measurement/calibrate/least_squares.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// A constant to find; its start is the value in the settings of the campaign.
struct SoughtConstant {
  fem::RegionConstant constant;
  double low = 0, high = 0;  ///< Pa, or pure
};

/// The constants whose profile likelihood is computed: none, all that are sought, or those whose
/// linearised interval is in doubt, wider than a tenth of the value to either side or correlated
/// beyond 0.95 with another one.
enum class Profiles { None, Doubtful, All };

struct InverseSettings {
  fem::CampaignSettings campaign;  ///< materials (starts), tool, tolerance, threads
  std::vector<SoughtConstant> sought;
  int depths = 6;      ///< of each measured curve that are compared, evenly spaced
  bool drags = false;  ///< compare measured drags as well
  double confidence = 0.95;
  Profiles profiles = Profiles::Doubtful;
  std::function<void(const std::string& line)> log;  ///< one line an evaluation; may be empty
};

/// One path as it was fitted.
struct InversePath {
  std::int32_t vertex = -1;
  PathKind kind = PathKind::Normal;
  double lateral_depth = 0;                                  ///< m, of a lateral path
  std::vector<double> depth, measured, fitted, uncertainty;  ///< m, N, N, N (NaN unknown)
  double contact_shift = 0;                                  ///< m, found with the constants
};

struct InverseFit {
  calibrate::Calibration calibration;  ///< the sought constants; then the contact shifts
  std::vector<InversePath> paths;
  double rms = 0;               ///< N
  double relative_rms = 0;      ///< over the largest measured force
  int evaluations = 0;          ///< of the finite element model, for the best fit
  int profile_evaluations = 0;  ///< and for the profiles
};

/// Measured drags are compared with lateral paths of the model without slip, at their depth;
/// lateral paths that were made from the normal one are no measurement and left out.
/// Where a measured path states the uncertainty of its contact point, the shift of that point is
/// sought as well, weighted by the stated uncertainty: an error of the contact point acts on all
/// samples of a curve alike and must not be averaged away. On a drag it acts through the depth, as
/// force/(2 depth). Where every sample states its
/// uncertainty the residuals are divided by what the shift leaves of it, and the intervals follow
/// from that; otherwise the scatter is estimated from the residuals. The samples of a path follow
/// each other: where they are missed alike the intervals count it (LeastSquares::series). Profiles
/// cost one to three evaluations an end where one constant is sought, up to some twenty where there
/// are more; ends are found to a hundredth of their distance.
/// @throws Error(Configuration) for curves of another tool, sites that are not of the body, no
///   measured normal path, constants of unknown regions; when the model fails at the start.
InverseFit calibrate_inverse(const Body& body, const Curves& measured,
                             const InverseSettings& settings);

}  // namespace palpate::app
