// SPDX-License-Identifier: AGPL-3.0-or-later
// Where a mesh does not represent its domain, and so must be finer.
#pragma once

#include <vector>

#include "mesher/volume/oracle.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

struct Faults {
  std::vector<Vec3> pinches;  ///< nodes at which the boundary touches itself
  std::vector<Vec3> islands;  ///< middles of parts that are connected to the largest by no face
  std::vector<Vec3> flat;     ///< middles of tetrahedra with too large a dihedral angle
  std::vector<Vec3> lost;     ///< points of interfaces far from the interfaces of the mesh
};

struct FaultLimits {
  double largest_dihedral = 175;  ///< degrees
  SizeField far;                  ///< distance from which on an interface counts as lost
};

/// @param interface points of all interfaces of the domain
Faults find_faults(const VolumeMesh& mesh, const std::vector<Crossing>& interface,
                   const FaultLimits& limits);

}  // namespace palpate::mesher
