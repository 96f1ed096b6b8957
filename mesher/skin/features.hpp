// SPDX-License-Identifier: AGPL-3.0-or-later
// Sharp edges of a surface. Only .cpp files that use CGAL include this.
#pragma once

#include <cstddef>

#include "mesher/geometry/cgal_mesh.hpp"

namespace palpate::mesher {

using EdgeFlags = Mesh::Property_map<Mesh::Edge_index, bool>;

/// Sharp edges of a noisy surface come in fragments. One that is shorter than this many spacings is
/// no feature: its ends could not be moved and would force tiny edges.
inline constexpr double kShortestFeature = 3;

/// Flags the edges whose dihedral deviation is over `angle` (rad), but for connected fragments
/// shorter than kShortestFeature spacings.
/// @param[out] dropped number of edges in such fragments
EdgeFlags flag_sharp_edges(Mesh& mesh, double angle, double spacing, std::size_t& dropped);

}  // namespace palpate::mesher
