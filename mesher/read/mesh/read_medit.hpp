// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// Reads the MEDIT format of text (.mesh), which CGAL, Mmg, fTetWild and Gmsh write.
/// The region of a tetrahedron is "region=3" for its reference, or "matrix" for reference 0.
/// References of triangles other than 0 give the sets of nodes "marker=2".
/// @param file named in errors
/// @throws Error(Geometry) with file and line.
MeshEntities read_medit(std::string_view bytes, const std::string& file);

}  // namespace palpate::mesher
