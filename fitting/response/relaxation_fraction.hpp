// SPDX-License-Identifier: AGPL-3.0-or-later
// How much of the normal response of a node relaxes.
#pragma once

#include <vector>

#include "format/curves.hpp"

namespace palpate::fitting {

/// g_i of a node for each time of the curves, 1: with E_r the isochoric strain energy of region r,
/// E the energy stored at a depth and g_ri the series of the regions,
///   g_i = sum over r of g_ri E_r / E,
/// at the deepest sample of the normal path. E_r is the derivative of E by the logarithm of the
/// moduli of region r, so that the response to a small change of them is exact, and that to a large
/// one of first order. @pre the site has a normal path with a sample under load
/// @throws Error(Configuration) where the samples lack the energies of the regions
std::vector<float> relaxation_fractions(const SiteCurves& site, const RegionRelaxation& relaxation);

/// Largest difference between the fraction at a depth and that of relaxation_fractions(), summed
/// over the times, weighted by the energy there over that of the deepest sample, 1. What one
/// fraction for a node misses of tissue in layers.
double largest_fraction_error(const SiteCurves& site, const RegionRelaxation& relaxation);

}  // namespace palpate::fitting
