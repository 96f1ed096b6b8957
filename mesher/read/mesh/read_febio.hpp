// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// Reads the mesh of an input file of FEBio, file format 2.0, 2.5, 3.0 or 4.0: Nodes, Elements
/// (tet4, tet10), NodeSet, ElementSet and Surface. The region of a tetrahedron is the name of its
/// Elements, else that of their material.
/// @throws Error(Geometry) with the line.
MeshEntities read_febio(std::string_view bytes, const std::string& file);

}  // namespace palpate::mesher
