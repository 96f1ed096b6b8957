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
  double set_up_seconds = 0;  ///< wall-clock time before the first site
  double cpu_seconds = 0;     ///< sum over the sites
  std::int64_t unknowns = 0;
  std::vector<std::pair<std::string, std::string>> facts;  ///< BLAS kernel, factor size, versions
};

struct CampaignCache;

/// Presses every site. The results are in ascending order of vertex, whatever the number of
/// threads. A site whose solve failed is data, with its status, reason and partial curve.
/// @param cache  what earlier campaigns on this body have computed; on a large mesh a factorization
///   takes as long as dozens of sites. May be null. With the same laws the bits are the same.
/// @throws Error(Geometry) when the body has no equilibrium under its weight.
/// @throws Error(Configuration) for constants out of range (named, with value and range), a region
///   without a law, a law without a region, a lateral depth that exceeds the depth, a vertex that
///   is not a site.
Curves run_campaign(const Body& body, const CampaignSettings& settings, CampaignReport& report,
                    CampaignCache* cache = nullptr);

/// Displacement of the nodes of the body (corner nodes, same order as Body::nodes) from their given
/// positions for one site at
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
