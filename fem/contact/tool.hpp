// SPDX-License-Identifier: AGPL-3.0-or-later
// Rigid tools: their shapes as signed distances.
#pragma once

#include <Eigen/Core>
#include <string>

namespace palpate::fem {

enum class ToolShape {
  Sphere,
  Disc,     ///< the flat end of a long upright cylinder, its edge sharp or rounded
  Cylinder  ///< a lying cylinder with ends rounded to hemispheres
};

/// Whether the surface may slide along the tool on the normal path.
enum class ToolFriction { Frictionless, NoSlip };

/// Size and shape of a tool, m.
struct ToolGeometry {
  ToolShape shape = ToolShape::Sphere;
  double radius = 0.005;   ///< of the sphere, the disc or the cross-section of the cylinder
  double edge_radius = 0;  ///< disc: fillet of its edge, 0 (sharp) to `radius`
  double length = 0;       ///< cylinder: between the centres of its ends

  /// Largest distance of a point of the end of the tool from the line of its normal path.
  double extent() const;
};

/// Name of a shape in cases and files: "sphere", "disc", "cylinder".
std::string name_of(ToolShape shape);
/// Name in cases and files: "frictionless", "no-slip".
std::string name_of(ToolFriction friction);

/// @throws Error(Configuration) naming the size, its value and range: radius > 0; edge_radius 0 ..
/// radius, of a disc only; length > 0, of a cylinder only.
void check_tool(const ToolGeometry& geometry);

/// Signed distance of a point to the surface of a tool, negative inside, with its derivatives.
struct Gap {
  double distance;            ///< m
  Eigen::Vector3d normal;     ///< unit, out of the tool: d(distance)/dx
  Eigen::Matrix3d curvature;  ///< d2(distance)/dx2, 1/m
};

/// A tool at a position. Its tip is the point that is pressed in first.
struct Tool {
  ToolGeometry geometry;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  Eigen::Vector3d inward = -Eigen::Vector3d::UnitZ();  ///< unit, out of the tool at its tip
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();     ///< unit, normal to inward; of a cylinder

  bool has_sharp_edge() const {
    return geometry.shape == ToolShape::Disc && geometry.edge_radius == 0;
  }
  /// Signed distance to the plane of the tip, negative on the side of the tool.
  double beyond_end(const Eigen::Vector3d& x) const { return (x - tip).dot(inward); }
  double from_axis(const Eigen::Vector3d& x) const {
    return (x - tip - beyond_end(x) * inward).norm();
  }

  double distance(const Eigen::Vector3d& x) const;
  Gap gap(const Eigen::Vector3d& x) const;
};

}  // namespace palpate::fem
