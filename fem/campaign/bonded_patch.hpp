// SPDX-License-Identifier: AGPL-3.0-or-later
// A patch of the surface moved as a whole, as by a bonded tool: an indentation without contact,
// which any finite element program can repeat node by node.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fem/campaign/settings.hpp"
#include "fem/mesh/quadratic_mesh.hpp"
#include "format/body.hpp"

namespace palpate::fem {

struct BondedPatch {
  QuadraticMesh mesh;               ///< `fixed`: by the supports alone
  std::vector<std::int32_t> nodes;  ///< of the mesh, moved together
};

/// The surface nodes within `radius` of a response vertex, with the mid-edge nodes of the facets
/// between them.
/// @throws Error(Configuration) for a vertex that is not a site, a radius that is not positive, or
/// a patch that reaches a support.
BondedPatch bonded_patch(const Body& body, std::int32_t vertex, double radius);

struct PatchForce {
  double depth = 0;          ///< m, of the patch along the press direction of the vertex
  Vec3 force{};              ///< N, of the tool on the body
  double strain_energy = 0;  ///< J
};

struct PatchCurve {
  std::vector<PatchForce> samples;  ///< from rest to the depth, or to where the path ended
  std::string reason;               ///< why it ended early; empty when it did not
};

/// Moves the patch inward by the depth and the increments of `settings.indentation`, with its
/// materials and element; Newton with a factorization of the whole body. The relative error of the
/// force is about 1e-6. The curve ends where strong ellipticity is lost.
/// @throws Error(Configuration) as bonded_patch and run_campaign.
PatchCurve press_patch(const Body& body, const CampaignSettings& settings, std::int32_t vertex,
                       double radius);

}  // namespace palpate::fem
