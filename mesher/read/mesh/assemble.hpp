// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "mesher/geometry/text.hpp"
#include "mesher/read/mesh/mesh_entities.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

/// The mesh that a file lists, in metres, checked.
///
/// Tetrahedra of negative volume are turned. Nodes of no corner of a tetrahedron are dropped, from
/// the sets too. Every region is also a set of its nodes, unless the file has a set of that name.
/// Where the boundary touches itself it is taken apart (separate_sheets). Mid-nodes of quadratic
/// tetrahedra become curved edges on the boundary; inside the body edges are straight, and where
/// the file had them curved, the log says how much.
/// @param unit m per unit of the file
/// @throws Error(Geometry), with the place in the body and the number of the element, when there is
///   no tetrahedron or there are volume elements of other shapes; for a coordinate that is not
///   finite, an implausible size, a tetrahedron with a repeated node or no volume, elements that
///   are listed twice or overlap, a body in several parts or with a boundary that is no manifold, a
///   boundary edge that bulges by more than kMostBulge of its length.
VolumeMesh assemble(MeshEntities entities, double unit, const std::string& where, const Log& log);

}  // namespace palpate::mesher
