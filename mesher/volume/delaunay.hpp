// SPDX-License-Identifier: AGPL-3.0-or-later
// Tetrahedra for any closed surface and the regions inside it, by restricted Delaunay refinement.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/volume/domain.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

struct DelaunaySettings {
  double element_size = 0;           ///< m, of the edges at the surface
  double interior_coarsening = 1.6;  ///< of the edges far below the surface / element_size
  /// By how much edges at this point of the surface may be longer than element_size: 1 or more;
  /// empty: 1 everywhere.
  std::function<double(const Vec3&)> surface_coarsening;
  double most_volume_change = 0.03;  ///< of the body, in parts of what the skin encloses
  double largest_dihedral = 175;     ///< degrees
  std::size_t most_nodes = 2'000'000;
  Log log;
};

/// What became of the domain.
struct DelaunayReport {
  Quality quality;
  double volume_of_domain = 0;     ///< m^3
  double volume_change = 0;        ///< of the tetrahedra, in parts of the volume of the domain
  double distance_to_surface = 0;  ///< m, largest, from the boundary facets to the skin
  Vec3 distance_to_surface_at{};   ///< m
  double distance_to_mesh = 0;     ///< m, largest, from the skin to the boundary facets
  Vec3 distance_to_mesh_at{};      ///< m
  int attempts = 0;
};

/// Fills the domain. Every facet of an interface belongs to two tetrahedra; facets between the body
/// and the void form closed manifold surfaces.
/// Where the body is thinner than the elements, they become smaller.
/// Equal arguments give equal meshes, to the bit; the scale of the coordinates does not matter.
/// @throws Error(Geometry), with the place, where no such mesh within the limits of the settings is
///   found.
VolumeMesh mesh_domain(const Domain& domain, const DelaunaySettings& settings,
                       const std::string& where, DelaunayReport& report);

}  // namespace palpate::mesher
