// SPDX-License-Identifier: AGPL-3.0-or-later
// Sharp edges of a surface. Only .cpp files that use CGAL include this.
#pragma once

#include <cstddef>
#include <vector>

#include "format/vec3.hpp"
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

/// Flags the edges of an outline as well, but those that run close beside flagged ones and
/// connected fragments shorter than kShortestFeature spacings: triangles of one spacing have no
/// room there.
/// @return the length of the others, m
double flag_outline(Mesh& mesh, const std::vector<Edge>& outline, double spacing, EdgeFlags flags);

using VertexFlags = Mesh::Property_map<Mesh::Vertex_index, bool>;

/// Flags the corners of outlines, where their flagged edges turn by more than 45 degrees within
/// half a spacing to both sides; no two of them are closer than that.
VertexFlags flag_corners(Mesh& mesh, const std::vector<std::vector<Edge>>& outlines, double spacing,
                         const EdgeFlags& flags);

}  // namespace palpate::mesher
