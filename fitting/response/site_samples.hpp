// SPDX-License-Identifier: AGPL-3.0-or-later
// What the paths of one site say about the two responses of its node.
#pragma once

#include <vector>

#include "fitting/response/curve_fit.hpp"
#include "format/curves.hpp"

namespace palpate::fitting {

/// f^z: (displacement, force . inward) of every sample of every normal path.
std::vector<ForceSample> normal_samples(const SiteCurves& site);

/// Deepest displacement of the normal paths, m; 0 without any.
double normal_reach(const SiteCurves& site);

/// f^r of each lateral path by itself: (displacement, (force - force at the held state) .
/// direction).
std::vector<std::vector<ForceSample>> lateral_paths(const SiteCurves& site);

/// One f^r for the node: the mean over azimuths and held depths. The decoupled model of the local
/// contact (28)-(29) has no dependence of f^r on depth or direction; the raw curves keep it. Paths
/// of different length are averaged in their slopes: where a path has ended, the mean slope of the
/// others continues the curve, so that it never jumps.
std::vector<ForceSample> mean_lateral(const std::vector<std::vector<ForceSample>>& paths);

}  // namespace palpate::fitting
