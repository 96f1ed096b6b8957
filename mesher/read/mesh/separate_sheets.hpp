// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "mesher/geometry/text.hpp"
#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// Where tetrahedra meet in a node without a chain of common faces through that node, the boundary
/// is no manifold. There each group of tetrahedra that such chains join gets a node of its own, at
/// the same place and in the same sets: a hinge is cut, and no element changes its shape. What the
/// tetrahedra share beside the node stays shared. The log states how many nodes, and the first
/// place. Coordinates are in metres.
void separate_sheets(MeshEntities& entities, const std::string& where, const Log& log);

}  // namespace palpate::mesher
