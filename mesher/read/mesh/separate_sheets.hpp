// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "mesher/geometry/text.hpp"
#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// Splits the nodes of elements that meet in a node or an edge alone (split_nodes), where the
/// boundary is no manifold: a hinge is cut, and no element changes its shape. Copies of a node are
/// in its sets. The log states how many, and the first place. Coordinates are in metres.
void separate_sheets(MeshEntities& entities, const std::string& where, const Log& log);

}  // namespace palpate::mesher
