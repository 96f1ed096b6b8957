// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// Reads the mesh of an input file of Abaqus or CalculiX: *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE;
/// other keywords are skipped. The region of a tetrahedron is the element set of its *SOLID
/// SECTION. Without sections it is the element set that it belongs to, where there is one and no
/// more; else that of its *ELEMENT, or "matrix". Node sets, element sets and
/// surfaces become sets of nodes.
/// @throws Error(Geometry) with the line; for *INCLUDE and what makes nodes or elements of others.
MeshEntities read_abaqus(std::string_view bytes, const std::string& file);

}  // namespace palpate::mesher
