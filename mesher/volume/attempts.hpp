// SPDX-License-Identifier: AGPL-3.0-or-later
// Refinement of a domain, repeated with smaller elements where the mesh is faulty.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mesher/geometry/text.hpp"
#include "mesher/volume/delaunay_report.hpp"
#include "mesher/volume/oracle.hpp"
#include "mesher/volume/sizing.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

/// All lengths in the coordinates of the oracle.
struct MeshRequest {
  const Oracle& oracle;
  std::vector<SizeSource> sizes;  ///< wanted edges at the surfaces
  SizeField largest;              ///< edges are not longer than this
  double element_size = 0;
  double most_volume_change = 0;  ///< as in DelaunaySettings
  double largest_dihedral = 0;    ///< degrees
  std::size_t most_nodes = 0;
  std::function<std::string(const Vec3&)> place;  ///< text of a point, for messages
  std::string where;
  Log log;
};

/// Refines until the mesh is sound, at most a few times; then takes apart what touches itself and
/// drops what is connected to the body by no face.
/// Writes attempts, removed_fraction, and the measures of the report in the coordinates of the
/// oracle.
/// @throws Error(Geometry) as mesh_domain
VolumeMesh refine_until_sound(MeshRequest request, DelaunayReport& report);

}  // namespace palpate::mesher
