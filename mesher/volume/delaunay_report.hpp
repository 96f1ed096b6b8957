// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstddef>

#include "mesher/geometry/quality.hpp"

namespace palpate::mesher {

/// What became of the domain.
struct DelaunayReport {
  Quality quality;
  double volume_of_domain = 0;     ///< m^3
  double volume_change = 0;        ///< of the tetrahedra, in parts of the volume of the domain
  double distance_to_surface = 0;  ///< m, largest, from the boundary facets to the skin
  Vec3 distance_to_surface_at{};   ///< m
  double distance_to_mesh = 0;     ///< m, largest, from the skin to the boundary facets
  Vec3 distance_to_mesh_at{};      ///< m
  int attempts = 0;                ///< refinements from the start, each finer where the last failed
  double removed_fraction = 0;     ///< of the volume: parts that no face connects to the body
  std::size_t split_nodes = 0;  ///< nodes added where parts of the body touched in a node or edge
  std::size_t filled_tips = 0;  ///< voids whose tip was filled where it touched another void
};

}  // namespace palpate::mesher
