// SPDX-License-Identifier: AGPL-3.0-or-later
// Derivatives of the tool force by the constants of the regions: the adjoint of the indentation,
// solved at the equilibria of the campaign.
#pragma once

#include <string>
#include <vector>

#include "fem/campaign/indentation.hpp"

namespace palpate::fem {

struct CampaignCache;

/// A constant of the law of one region, by its name in the table of laws.
struct RegionConstant {
  std::string region;
  std::string name = "young";
};

/// Force along the press direction at one depth, N, and its derivative by each constant, N/Pa for
/// a stress, N for a dimensionless constant.
struct ForceSensitivity {
  double depth = 0;
  double force = 0;
  std::vector<double> slope;
};

struct SiteSensitivity {
  std::int32_t vertex = -1;
  std::string reason;                     ///< why a path ended early; empty when none did
  std::vector<ForceSensitivity> samples;  ///< at the depths that were reached
  /// One for each plan: force along its direction, with the travel as `depth`.
  std::vector<std::vector<ForceSensitivity>> lateral;
};

/// Presses the sites to the given depths, which replace settings.indentation.depth, and
/// differentiates. With R(u, c) = 0 the equilibrium, K its tangent and F(u, c) the force of the
/// tool,
///   K l = dF/du,   dF/dc = dF/dc|_u - l . dR/dc|_u,
/// one solve per sample for any number of constants, exact for the discrete model: the contact
/// penalty is proportional to the largest modulus at the surface and is differentiated with it.
/// Sites run concurrently as in a campaign, and the solves share its factor. The body is factorized
/// only at rest, and not again where the cached factor serves.
/// Bonded surface is tied at its position at the end of an increment, u_b, so that a force also
/// depends on the states u_b at which its ties were made: those of all increments of a no-slip
/// normal path, and the one from which a lateral path starts. Backwards through them, with v the
/// derivative of F - l . R by u_b (k (l + direction) at a tied node), K_b m = v adds - m . dR_b/dc,
/// and m is added to l for the ties that were made before: one solve per increment. The stiffness
/// of a tie depends on the fraction of the surface around its node that is in contact, a count of
/// quadrature points: it is piecewise constant, and only its derivative by the modulus is included.
/// With refined elements the slopes are central differences over a hundredth of each constant: two
/// more presses of all sites for each.
/// @param lateral  for each site the lateral paths to follow; empty: none.
/// @param cache  the factor of earlier calls for the same body, with other constants; may be null.
/// @throws Error(Configuration) as run_campaign; for a region that the body does not have; with
/// gravity.
std::vector<SiteSensitivity> run_sensitivity(
    const Body& body, const CampaignSettings& settings, const std::vector<double>& depths,
    const std::vector<RegionConstant>& constants,
    const std::vector<std::vector<LateralPlan>>& lateral = {}, CampaignCache* cache = nullptr);

}  // namespace palpate::fem
