// SPDX-License-Identifier: AGPL-3.0-or-later
// A triangulated surface in memory, free of any geometry library.
#pragma once

#include <string>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::mesher {

/// The names of a face in its file: those of its object, its groups and its material.
using Names = std::vector<std::string>;

/// Closed and oriented outward once it has passed `read_surface`.
struct Surface {
  std::vector<Vec3> points;  ///< m
  std::vector<Triangle> triangles;
  std::vector<std::size_t> names;  ///< of each triangle, index into known_names; may be empty
  std::vector<Names> known_names;
};

double distance_to_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c);

struct Bounds {
  Vec3 low{}, high{};
};

Bounds bounds(const std::vector<Vec3>& points);

/// "(0, 0, -3) mm to (50, 50, 20) mm": the corners of the bounds.
std::string extent_of(const std::vector<Vec3>& points);
double largest_dimension(const std::vector<Vec3>& points);

/// (b - a) x (c - a): twice the area times the unit normal.
Vec3 area_vector(const std::vector<Vec3>& points, const Triangle& triangle);

double area(const Surface& surface);

/// Sum of a . (b x c) / 6 about the first point: positive when oriented outward [divergence
/// theorem]. The origin is moved to the surface so that no digits are lost far from it.
double signed_volume(const Surface& surface);

/// 2 V / A, m: the distance between the sides of a closed sheet; 0 without area.
double mean_thickness(const Surface& surface);

void append(Surface& surface, const Surface& more);

/// For each point, the triangles around it.
std::vector<std::vector<std::int32_t>> incident_triangles(std::size_t points,
                                                          const std::vector<Triangle>& triangles);

Vec3 unit(const Vec3& a);

}  // namespace palpate::mesher
