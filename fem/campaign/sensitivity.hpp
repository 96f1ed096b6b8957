// SPDX-License-Identifier: AGPL-3.0-or-later
// How the force of a normal path depends on the constants of the regions: the adjoint of the
// indentation, solved at the equilibria that the campaign finds.
#pragma once

#include <string>
#include <vector>

#include "fem/campaign/indentation.hpp"

namespace palpate::fem {

/// A constant of the law of one region, by its name in the table of laws.
struct RegionConstant {
  std::string region;
  std::string name = "young";
};

/// Force along the inward direction at one depth, N, and its derivative by each constant, N/Pa for
/// a stress, N for a pure number.
struct ForceSensitivity {
  double depth = 0;
  double force = 0;
  std::vector<double> slope;
};

struct SiteSensitivity {
  std::int32_t vertex = -1;
  std::string reason;                     ///< why a path ended early; empty when none did
  std::vector<ForceSensitivity> samples;  ///< of the depths that were reached
  /// One for each plan: force along its direction, `depth` the travel.
  std::vector<std::vector<ForceSensitivity>> lateral;
};

/// Press the sites to the given depths (settings.indentation.depth is the last of them) and
/// differentiate. With R(u, c) = 0 the equilibrium, K its tangent and F(u, c) the force of the
/// tool,
///   K l = dF/du,   dF/dc = dF/dc|_u - l . dR/dc|_u,
/// one solve a sample for any number of constants, exact for the discrete model at the equilibrium:
/// the contact penalty follows the stiffest modulus at the surface and is differentiated with it.
/// Sites run abreast as in a campaign, and the solves share its factor: none of the body is made
/// but that at rest, and that one not again where a factor that was kept will do.
/// What sticks is tied where it is at the end of an increment, u_b, so that a force also depends on
/// the states u_b at which its ties were made: those of all increments of a normal path that sticks
/// (ToolFriction::NoSlip), and the one from which a lateral path starts. Backwards through them,
/// with v the derivative of F - l . R by u_b (k (l + direction) at a tied node), K_b m = v adds
/// - m . dR_b/dc, and m is added to l for the ties that were made before: a solve an increment.
/// How firmly a node is tied follows the share of the surface around it that is in contact, a count
/// of quadrature points: it has jumps, and no derivative beside that by the modulus.
/// @param lateral  for each site the lateral paths to follow; empty: none.
/// @param kept  the factor of earlier calls for the same body, with other constants; may be null.
/// @throws Error(Configuration) as run_campaign; for a region that the body has not;
/// with gravity.
std::vector<SiteSensitivity> run_sensitivity(
    const Body& body, const CampaignSettings& settings, const std::vector<double>& depths,
    const std::vector<RegionConstant>& constants,
    const std::vector<std::vector<LateralPlan>>& lateral = {}, FactorCache* kept = nullptr);

}  // namespace palpate::fem
