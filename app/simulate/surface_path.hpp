// SPDX-License-Identifier: AGPL-3.0-or-later
// The point of the press and the path along the surface of a scripted session.
#pragma once

#include <vector>

#include "format/library.hpp"
#include "format/vec3.hpp"

namespace palpate::app {

struct PathPoint {
  double distance = 0;  ///< m, along the surface from the start
  Vec3 position{};      ///< m
  Vec3 inward{};        ///< unit, interpolated as the runtime does
};

/// The triangle with the most triangles between it and any border of the part of the surface that
/// has responses; the first of equals. @throws Error(Configuration) when no triangle has responses.
std::size_t middle_triangle(const Library& library);

/// Walk over the triangles that have responses, from the middle of `start`, straight on: at an edge
/// the direction is projected on the next triangle, as the contact point slides. Of 16 directions
/// the one that leads farthest is taken, up to `length`, or until the press direction has turned
/// by 60 degrees. Points lie at most `step` apart.
std::vector<PathPoint> straight_path(const Library& library, std::size_t start, double length,
                                     double step);

/// Walk over the triangles that have responses, from the middle of the one nearest to `from` to the
/// middle of the one nearest to `to`, aiming at it in each triangle. Points lie at most `step`
/// apart. @throws Error(Configuration) when a point is farther from its triangle than the triangle
/// is long, or the walk does not arrive.
std::vector<PathPoint> path_between(const Library& library, const Vec3& from, const Vec3& to,
                                    double step);

/// The point at a distance from the start, between its neighbours; the ends beyond them.
PathPoint point_at(const std::vector<PathPoint>& path, double distance);

}  // namespace palpate::app
