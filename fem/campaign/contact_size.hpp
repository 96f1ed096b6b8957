// SPDX-License-Identifier: AGPL-3.0-or-later
// Where the contact of a tool with the body begins, and how large it grows.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/contact/tool.hpp"
#include "fem/mesh/quadratic_mesh.hpp"

namespace palpate::fem {

/// A line on the surface from which the edge of the contact moves away: a point under a sphere, a
/// segment under a cylinder, and the ring where the fillet of a disc begins.
struct ContactCore {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_axis = Eigen::Vector3d::Zero();  ///< m, from the centre to an end: a segment
  Eigen::Vector3d inward = -Eigen::Vector3d::UnitZ();   ///< unit, of a ring
  double ring_radius = 0;                               ///< m; 0: no ring
  double ring_sag = 0;  ///< m, by which the ring lies deeper than the centre
  double smallest = 0;  ///< m, distance of the edge at the first increment
  double largest = 0;   ///< m, at the last

  /// The point of the line that is nearest to x.
  Eigen::Vector3d nearest(const Eigen::Vector3d& x) const;
};

/// Normal curvatures of the surface around a point, 1/m, positive where the body is convex:
/// sag = (k11 x^2 + 2 k12 x y + k22 y^2)/2 along the axes of a frame.
struct SurfaceCurvature {
  double k11 = 0, k12 = 0, k22 = 0;
  double mean() const { return 0.5 * (k11 + k22); }
};

/// The least-squares paraboloid through the nodes of the boundary within `reach` of the point whose
/// facets face away from `inward`. `first`, `second`: the frame, normal to it. Zero where there are
/// too few nodes: a single facet is flat, or a rim.
SurfaceCurvature curvature_at(const QuadraticMesh& mesh, const Eigen::Vector3d& point,
                              const Eigen::Vector3d& inward, const Eigen::Vector3d& first,
                              const Eigen::Vector3d& second, double reach);

/// The contact of a tool, its tip at a point of the surface, from `first_depth` to `last_depth`.
/// With R the radius of the tool and 1/R' = 1/R + k, k the curvature of the body across the
/// contact, the edge is at about sqrt(R' d) [Hertz 1881; of the sphere exactly]. A disc that is
/// flatter than the body is touched at the middle first, too. Curvatures that would make R' more
/// than four times R, or less than a quarter, count as these. Empty for a sharp disc, whose contact
/// has no size but its own.
std::vector<ContactCore> contact_cores(const QuadraticMesh& mesh, const Tool& tool,
                                       double first_depth, double last_depth);

}  // namespace palpate::fem
