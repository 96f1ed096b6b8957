// SPDX-License-Identifier: AGPL-3.0-or-later
// The campaign: one nonlinear indentation, normal then lateral, at every site of a body.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fem/campaign/settings.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"

namespace palpate::fem {

/// What the campaign did, for the log and the provenance.
struct CampaignReport {
  double seconds = 0;
  double set_up_seconds = 0;  ///< on the clock, before the first site
  double cpu_seconds = 0;     ///< of the sites
  std::int64_t unknowns = 0;
  std::vector<std::pair<std::string, std::string>> facts;  ///< BLAS kernel, factor size, versions
};

class FactorCache;

/// The sites come back in ascending order of vertex whatever the number of threads. A site whose
/// solve failed is data: its status, reason and partial curve are kept.
/// @param kept  the factor of earlier campaigns on this body, which on a large mesh takes as long
/// as
///   dozens of sites; may be null. With the same laws it changes no bit.
/// @throws Error(Geometry) when the body finds no equilibrium under its weight.
/// @throws Error(Configuration) for constants out of range (named, with value and range), a region
///   without a law, a law without a region, a held depth beyond the depth, a vertex that is no
///   site.
Curves run_campaign(const Body& body, const CampaignSettings& settings, CampaignReport& report,
                    FactorCache* kept = nullptr);

/// Displacement of the nodes of the body (corner nodes, same order as Body::nodes) for one site at
/// the end of its normal path: for pictures and exports.
struct DeformedState {
  std::vector<Vec3> displacement;             ///< (N) m
  std::vector<double> strain_energy_density;  ///< (T) J/m^3, element mean
  std::vector<double> pressure;               ///< (T) Pa, element mean, tension positive
  std::vector<double> smooth_pressure;        ///< (T) Pa, see SmoothPressure
  double pressure_alternation = 0;            ///< see SmoothPressure
  CurveSample sample;
};
DeformedState deformed_state(const Body& body, const CampaignSettings& settings,
                             std::int32_t vertex);

}  // namespace palpate::fem
