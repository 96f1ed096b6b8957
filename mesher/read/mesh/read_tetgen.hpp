// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// A file that belongs to a mesh, and its name in errors. Empty bytes: there is no such file.
struct NamedBytes {
  std::string_view bytes;
  std::string file;
};

/// Reads the files .node and .ele, and .face where it is given, of TetGen. The region of a
/// tetrahedron is "region=3" for its first attribute, or "matrix" without attributes. Boundary
/// markers of nodes and faces other than 0 give the sets "marker=2".
/// @throws Error(Geometry) with file and line.
MeshEntities read_tetgen(const NamedBytes& node, const NamedBytes& ele, const NamedBytes& face);

}  // namespace palpate::mesher
