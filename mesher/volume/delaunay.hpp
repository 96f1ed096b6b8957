// SPDX-License-Identifier: AGPL-3.0-or-later
// Tetrahedra for any closed surface and the regions inside it, by restricted Delaunay refinement.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mesher/geometry/text.hpp"
#include "mesher/volume/delaunay_report.hpp"
#include "mesher/volume/domain.hpp"
#include "mesher/volume/label_oracle.hpp"
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

/// Fills the domain. Every facet of an interface belongs to two tetrahedra; facets between the body
/// and the void form closed manifold surfaces.
/// Where the body is thinner than the elements, they become smaller.
/// Equal arguments give equal meshes, to the bit; the scale of the coordinates does not matter.
/// @throws Error(Geometry), with the place, where no such mesh within the limits of the settings is
///   found.
VolumeMesh mesh_domain(const Domain& domain, const DelaunaySettings& settings,
                       const std::string& where, DelaunayReport& report);

/// The same for a body given by labels: the dimensions are those of the box of the field.
VolumeMesh mesh_labels(const LabelField& field, const DelaunaySettings& settings,
                       const std::string& where, DelaunayReport& report);

}  // namespace palpate::mesher
