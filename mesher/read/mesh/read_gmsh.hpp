// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// Reads the MSH formats 1, 2 and 4.1 of Gmsh, text or binary of either byte order.
/// The region of a tetrahedron is its first physical group; without one it is "matrix". Other
/// groups become sets of nodes: by the name of the physical group, else "physical surface 3", and
/// "surface 3" for an entity of the geometry without a group.
/// @param file named in errors
/// @throws Error(Geometry) with the place in the file.
MeshEntities read_gmsh(std::string_view bytes, const std::string& file);

}  // namespace palpate::mesher
