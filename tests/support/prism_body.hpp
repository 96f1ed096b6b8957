// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies for tests that are layers of prisms over a triangulation: round layers, shells.
#pragma once

#include <functional>
#include <vector>

#include "format/body.hpp"

namespace palpate::test {

/// A triangulation of a plane disc around the origin, or of an eighth of the unit sphere.
struct Triangulation {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

/// Rings of the given ascending radii around a centre point: 6, 12, 18 .. points up to `sectors`
/// times 6, then no more.
Triangulation rings(const std::vector<double>& radii, int sectors);

/// An eighth of the unit sphere, its three edges in `divisions` parts: their points lie exactly on
/// the planes of coordinates.
Triangulation octant_of_sphere(int divisions);

/// Three tetrahedra for each prism between a triangle of layer k and of layer k + 1. Node
/// `layer * points + point` lies at position(point, layer); layers 0 .. layers. No supports, one
/// region "tissue", no response surface.
Body make_prisms(const Triangulation& base, int layers,
                 const std::function<Vec3(const Vec3& point, int layer)>& position);

/// Curves the edges of the boundary with both ends at `radius` from the origin onto that sphere.
void curve_onto_sphere(double radius, Body& body);

}  // namespace palpate::test
