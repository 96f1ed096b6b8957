// SPDX-License-Identifier: AGPL-3.0-or-later
// A response surface of measured contact points alone: an open patch whose vertices are the sites.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::mesher {

/// Where a surface was touched.
struct ContactPoint {
  std::string name;  ///< for messages: "site 12"
  Vec3 position{};   ///< m
  Vec3 outward{};    ///< unit normal out of the body, as measured
};

struct Patch {
  std::vector<Triangle> triangles;    ///< of the points; counter-clockwise from outside
  Vec3 mean_normal{};                 ///< unit: the points are a height field along it
  double spacing = 0;                 ///< m, median distance from a point to its nearest one
  double steepest = 0;                ///< rad, largest angle between a facet and mean_normal
  double largest_turn = 0;            ///< rad, largest angle between a measured and a facet normal
  std::vector<std::string> warnings;  ///< one for each point that does not fit its neighbours
};

/// Delaunay triangles of the points in the plane across the mean of their normals [CGAL]. Triangles
/// at the border with an edge over twice the spacing, or a height below a quarter of it, are taken
/// away as long as every point keeps a triangle and the patch stays one disc.
///
/// A warning names the points that lie off the surface of their neighbours: with heights h and
/// slopes s by the measured normals, the median over neighbours j of
///   |h_i - h_j - (s_i + s_j)/2 . (x_i - x_j)|,
/// which is of third order in the spacing for a smooth surface, above six robust standard
/// deviations and a twentieth of the spacing.
/// @throws Error(Configuration), naming the points: fewer than three; a position or normal that is
///   not finite, a normal that is no unit vector; two points at one place (nearer than a tenth of
///   the spacing); points on one line; a normal over 60 degrees off the mean one, where the points
///   are no height field; a facet that the measured normals of its corners do not look out of; a
///   point with no other one within three spacings.
Patch make_patch(const std::vector<ContactPoint>& points, const std::string& where);

/// A place on a patch.
struct PatchPlace {
  std::size_t triangle = 0;
  Vec3 natural{};  ///< natural coordinates in it
};

/// The place of the patch that a position lies over along the mean normal; nothing beyond its
/// border.
std::optional<PatchPlace> place_on(const Patch& patch, const std::vector<ContactPoint>& points,
                                   const Vec3& position);

}  // namespace palpate::mesher
