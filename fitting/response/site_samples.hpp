// SPDX-License-Identifier: AGPL-3.0-or-later
// Samples of the normal and the lateral response from the paths of one site.
#pragma once

#include <vector>

#include "fitting/response/curve_fit.hpp"
#include "format/curves.hpp"

namespace palpate::fitting {

// The means of the force between the samples are those of the energies, where these are known.

/// f^z: (displacement, force . inward) of every sample of every normal path.
std::vector<ForceSample> normal_samples(const SiteCurves& site);

/// Largest displacement of the normal paths, m; 0 without any.
double normal_reach(const SiteCurves& site);

/// Depths of the lateral paths of a site, m, ascending.
std::vector<double> lateral_depths(const SiteCurves& site);

/// The lateral paths of a site at one of these depths.
SiteCurves paths_at(const SiteCurves& site, double lateral_depth);

/// The lateral paths whose direction is dragged at every lateral depth; all where none is. Depths
/// can then be compared: tissue may be stiffer in one direction than in another.
SiteCurves at_every_depth(const SiteCurves& site);

/// f^r of each lateral path: (displacement, (force - force at its first sample) . direction).
std::vector<std::vector<ForceSample>> lateral_paths(const SiteCurves& site);

/// f^r of the node: the mean over azimuths and lateral depths, since in the decoupled local model
/// (28)-(29) f^r depends on neither. Paths of different length are averaged in their slopes: beyond
/// the end of a path the mean slope of the others continues the curve without a jump.
std::vector<ForceSample> mean_lateral(const std::vector<std::vector<ForceSample>>& paths);

}  // namespace palpate::fitting
