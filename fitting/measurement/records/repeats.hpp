// SPDX-License-Identifier: AGPL-3.0-or-later
// Several presses of one site become one path of curves.h5: the mean, its scatter between the
// presses, and the standard uncertainty of the mean.
#pragma once

#include <string>
#include <vector>

#include "fitting/measurement/records/press.hpp"
#include "format/curves.hpp"

namespace palpate::measured {

struct RepeatSettings {
  int samples = 24;                   ///< of the path, evenly spaced in depth, at most
  double force_calibration = 0;       ///< relative standard uncertainty of the load cell
  double compliance_uncertainty = 0;  ///< m/N, standard
};

/// A sample whose energies and checks, which only a solver has, are unknown.
CurveSample measured_sample();

/// A press on a common grid of depths.
struct GriddedPress {
  std::vector<double> force;        ///< N, local mean line at each depth
  std::vector<double> uncertainty;  ///< N, standard, of that mean: independent noise alone
  std::vector<double> time;         ///< s, mean over the samples, from the start of the press
};

/// The loading branch at the given depths: at each the value of a straight line through the samples
/// within half a step. Few samples scatter about their line by chance: `noise`, the standard
/// deviation of a sample (N), is the least that is taken for it. @throws Error(Configuration) where
/// a step holds no sample.
GriddedPress on_grid(const std::vector<DepthForce>& branch, const std::vector<double>& depths,
                     const std::string& where, double noise = 0);

/// The loading branches as one normal path along `inward`, from the touch to the depth that all
/// presses reach. Depths above the first sample of a record that begins in contact are left
/// out. With the slope k and n presses:
///   force_scatter      sample standard deviation between the presses, unknown for one
///   force_uncertainty  u^2 = max(scatter^2, mean(noise^2 + v))/n + (r f)^2 + (k f u_C)^2,
/// where v is the variance of baseline and contact point together (CommonErrors), the noise is
/// widened for its autocorrelation, and the last two, calibration r and compliance u_C, are common
/// to all presses.
/// `contact_uncertainty` is the one of the mean contact point.
/// @throws Error(Configuration) as on_grid; for presses of which one reaches five times as deep.
CurvePath mean_path(const std::vector<PressCurve>& presses, const Vec3& inward,
                    const RepeatSettings& settings, const std::string& where);

/// A lateral path that nobody measured: the stiffness of the normal path at half its depth times
/// `ratio`, over half of that depth, in a direction across inward. For a contact without slip of an
/// elastic body the ratio is 2 (1 - nu)/(2 - nu) [Mindlin 1949]: 2/3 for an incompressible one.
/// `repeats` is 0, for it is computed.
CurvePath lateral_from_normal(const CurvePath& normal, double ratio);

}  // namespace palpate::measured
