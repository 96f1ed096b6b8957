// SPDX-License-Identifier: AGPL-3.0-or-later
// The surface of a library, from the response surface of the body.
#pragma once

#include <vector>

#include "format/body.hpp"
#include "format/library.hpp"
#include "format/vec3.hpp"

namespace palpate::fitting {

/// Bits of a coordinate of the surface. The further ones of a mesh mean nothing; as zeros they
/// take no room in a file, where coordinates would be half of a library.
inline constexpr int kCoordinateBits = 24;

/// h = 2^-kCoordinateBits of the power of two at or above the extent of a surface, the longest side
/// of its box; 0 where all points are one.
double grid_of(const std::vector<Vec3>& points);

/// The points on a grid of h: each within h/2 along each axis, 6e-8 of the extent at most.
std::vector<Vec3> on_a_grid(std::vector<Vec3> points);

/// Sets positions, inward directions and triangles of the library: those of the body without the
/// triangles that touch a support. Vertices keep their numbers. Positions are on_a_grid; directions
/// have multiples of 2^-kCoordinateBits for components, and length 1 within 6e-8.
void set_response_surface(const Body& body, Library& library);

/// True where the vertices of the library are those of the body, on the grid or not.
bool has_surface_of(const Body& body, const Library& library);

}  // namespace palpate::fitting
