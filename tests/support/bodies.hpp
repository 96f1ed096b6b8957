// SPDX-License-Identifier: AGPL-3.0-or-later
// Response libraries made in memory: shapes whose geometry and responses are known in closed form.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "format/library.hpp"

namespace palpate::test {

/// f = 100 k d^2 up to 5 mm, then k (d - 2.5 mm) [Mahvash & Hayward 2005, eqs. 34, 35].
ResponseCurve wall_curve(double stiffness);
/// f = k d.
ResponseCurve linear_curve(double stiffness);
/// Knots every `step` (m) with slopes rising from `first` to `last` (N/m).
ResponseCurve stiffening_curve(double first, double last, int knots, double step);

/// The responses of a node at x.
using Responses = std::function<NodeResponse(const Vec3& x)>;
NodeResponse wall_response(double stiffness, double lateral_stiffness);
/// The wall of the paper everywhere.
NodeResponse uniform(const Vec3& x);
/// Responses that differ from node to node; no slope of theirs is above kSteepestUneven, N/m.
NodeResponse uneven(const Vec3& x);
inline constexpr double kSteepestUneven = 500 * 1.6;

/// The same library with lateral responses that grow with depth, not alike everywhere; w(0) > 0.
Library coupled(Library library);

/// The same library with responses that relax: fractions of one half in all at the times given (s),
/// alike everywhere, or up and down by a third over the surface.
Library relaxing(Library library, const std::vector<double>& times, bool alike);

/// The same library with presses that lean by up to `most` across the press directions, in
/// directions that turn over the surface.
Library leaning(Library library, double most);
/// The same coupled library with soft axes up to `most` long across the press directions, in
/// directions that change over the surface.
Library soft_axes(Library library, double most);

/// Icosahedron subdivided `level` times, vertices on the sphere, directions radial.
Library sphere(int level, double radius, const Responses& responses);

/// The same with the vertices at r(direction) = radius (1 + amplitude sin 3x sin 4y sin 5z): hills
/// and valleys, star-shaped, directions normal to the mesh.
Library bumpy_sphere(int level, double radius, double amplitude, const Responses& responses);

/// Open cylinder about z, z in 0 .. length, `around` x `along` squares of two triangles, directions
/// radial.
Library cylinder(int around, int along, double radius, double length, const Responses& responses);

/// Square plate of n x n squares of two triangles in z = 0, side `side`, from the origin; the body
/// lies below, so the press direction is -z.
Library plate(int n, double side, const Responses& responses);

/// A plate of 80 mm of springs of 170 N/m, whose certificate is written by hand: L = 200 N/m,
/// L_min = 180 N/m, mu = 0.3.
Library plate_of_200(ResponseKind kind = ResponseKind::Decoupled);

/// Two parallel plates, `thickness` apart, each facing away from the other: a thin body, open at
/// the rim.
Library thin_body(int n, double side, double thickness, const Responses& responses);

/// Cube from the origin with n x n squares of two triangles on each face; the directions of edges
/// and corners are the mean of their faces.
Library cube(int n, double side, const Responses& responses);

}  // namespace palpate::test
