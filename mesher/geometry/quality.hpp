// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::mesher {

struct Quality {
  double smallest_dihedral = 180;  ///< degrees, over all edges of all tetrahedra
  double largest_dihedral = 0;     ///< degrees
  Vec3 largest_dihedral_at{};      ///< m, middle of that edge
  double largest_edge_ratio = 1;   ///< longest over shortest edge of one tetrahedron
  double longest_edge = 0;         ///< m
  double volume = 0;               ///< m^3, of all tetrahedra
};

Quality measure_quality(const std::vector<Vec3>& nodes, const std::vector<Tetrahedron>& tetrahedra);

/// (b - a) x (c - a) . (d - a) / 6
double volume(const std::vector<Vec3>& nodes, const Tetrahedron& tetrahedron);

std::string summary(const Quality& quality);

}  // namespace palpate::mesher
