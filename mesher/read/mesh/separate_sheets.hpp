// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "mesher/geometry/text.hpp"
#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// Takes the boundary apart where it touches itself (make_manifold). A new node is in the sets that
/// have all nodes it is made of; elements with the middle of a halved edge, and those that fill a
/// tip, are linear. The log states how many, and a place. Coordinates are in metres.
/// Elements that overlap are left as they are.
void separate_sheets(MeshEntities& entities, const std::string& where, const Log& log);

}  // namespace palpate::mesher
