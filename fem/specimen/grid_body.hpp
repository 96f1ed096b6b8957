// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies of simple shape whose mesh is a grid: slabs, bars and cylinders, or the part of them that
// their symmetry leaves.
#pragma once

#include <functional>
#include <vector>

#include "format/body.hpp"

namespace palpate::fem {

/// Ascending coordinates of the nodes along each axis of a grid.
struct CellGrid {
  std::vector<double> first, second, third;
};

/// From 0 to `end` in cells of about `fine` up to `core`, and then of cells that grow by the factor
/// `growth`.
std::vector<double> graded_cells(double end, double core, double fine, double growth);

/// The grid with its nodes moved by `map`, which keeps its handedness, six tetrahedra a cell [Kuhn
/// 1960]. Nodes that `map` sends to one point are one node, and tetrahedra without volume are left
/// out: a grid of cylindrical coordinates closes at its axis. One region, "specimen"; neither
/// supports nor response surface.
Body grid_body(const CellGrid& grid, const std::function<Vec3(const Vec3&)>& map);

/// Fixes the nodes where `on_support` holds.
void fix_where(Body& body, const std::function<bool(const Vec3&)>& on_support);

/// Lets the boundary facets with all nodes where `on_plane` holds slide along their plane, which
/// they do not leave but for a spring of `stiffness`, N/m^3: a plane of symmetry.
void slide_where(Body& body, const std::function<bool(const Vec3&)>& on_plane, double stiffness);

}  // namespace palpate::fem
