// SPDX-License-Identifier: AGPL-3.0-or-later
// Restricted Delaunay refinement of a domain.
#pragma once

#include <cstddef>
#include <string>

#include "mesher/volume/oracle.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

struct RefineSettings {
  SizeField facet_size;               ///< largest circumradius of a facet there
  SizeField cell_size;                ///< largest circumradius of a tetrahedron there
  SizeField seed_spacing;             ///< between the first nodes
  double facet_distance = 1.0 / 12;   ///< largest distance of a facet from the interface / its size
  double smallest_facet_angle = 25;   ///< degrees
  double radius_edge_ratio = 3;       ///< largest circumradius over shortest edge
  double smallest_dihedral = 10;      ///< degrees; flatter tetrahedra are perturbed and exuded
  std::size_t most_nodes = 0;         ///< refinement stops there
  bool refine_until_manifold = true;  ///< facets where the boundary touches itself are refined
};

struct Refinement {
  VolumeMesh mesh;         ///< without region names
  bool cut_short = false;  ///< stopped at most_nodes, or failed: then without tetrahedra
  std::string failure;     ///< what CGAL says of it
};

/// Delaunay refinement of surfaces and volumes [Boissonnat & Oudot 2005, Rineau & Yvinec 2007], as
/// CGAL has it, then perturbation and exudation of slivers [Tournois et al. 2009, Cheng et al.
/// 2000]. Lengths of the order of one: the tolerances of the caller's units stay out.
/// Equal arguments give equal meshes, to the bit.
Refinement refine(const Oracle& oracle, const RefineSettings& settings);

}  // namespace palpate::mesher
