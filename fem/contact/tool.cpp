// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/tool.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::fem {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

[[noreturn]] void refuse_size(const char* size, double value, const std::string& range,
                              const std::string& remedy) {
  throw Error(ErrorKind::Configuration, "tool",
              std::string(size) + " = " + length_text(value) + " is out of range",
              "give " + range + remedy);
}

/// Distance to a point or a line through it: `free` projects on the directions in which the
/// distance grows (all for a point, those normal to the line for a line).
Gap round_gap(const Vector3d& from_core, const Matrix3d& free, double radius) {
  const double distance = from_core.norm();
  const Vector3d n = from_core / distance;
  return {distance - radius, n, (free - n * n.transpose()) / distance};
}

/// The point of the axis of a lying cylinder that is nearest to x, and whether it is an end.
struct OnAxis {
  Vector3d point;
  bool end;
};
OnAxis nearest_on_axis(const Tool& tool, const Vector3d& x) {
  const Vector3d centre = tool.tip - tool.geometry.radius * tool.inward;
  const double half = 0.5 * tool.geometry.length;
  const double along = (x - centre).dot(tool.axis);
  return {centre + std::clamp(along, -half, half) * tool.axis, std::abs(along) > half};
}

/// A point relative to a disc, on the half plane through its axis. The disc is a core, the upright
/// cylinder of radius R - e with a flat end at height e, thickened by the edge radius e. A point
/// within the core is pushed along the axis, however deep it is, so that a tool that moves in does
/// not push the points at its rim aside.
struct AtDisc {
  Vector3d radial;    ///< unit, away from the axis (any direction on it)
  double r;           ///< distance from the axis
  double out, below;  ///< of the core: beyond its side, beyond its end
};
AtDisc at_disc(const Tool& tool, const Vector3d& x) {
  const Vector3d from_tip = x - tool.tip;
  const double depth = from_tip.dot(tool.inward);
  const Vector3d across = from_tip - depth * tool.inward;
  const double r = across.norm(), e = tool.geometry.edge_radius;
  const Vector3d radial = r > 0 ? Vector3d(across / r) : tool.axis;
  return {radial, r, r - (tool.geometry.radius - e), depth + e};
}

Gap disc_gap(const Tool& tool, const Vector3d& x) {
  const AtDisc p = at_disc(tool, x);
  const Vector3d& z = tool.inward;
  const double e = tool.geometry.edge_radius;
  if (p.out <= 0) return {p.below - e, z, Matrix3d::Zero()};  // the flat end
  const Vector3d hoop = z.cross(p.radial);
  if (p.below <= 0) return {p.out - e, p.radial, hoop * hoop.transpose() / p.r};  // the side
  const double distance = std::hypot(p.out, p.below);  // the edge: a torus
  const Vector3d n = (p.out * p.radial + p.below * z) / distance;
  const Vector3d meridian = (p.below * p.radial - p.out * z) / distance;
  return {distance - e, n,
          meridian * meridian.transpose() / distance +
              p.out / (distance * p.r) * (hoop * hoop.transpose())};
}

}  // namespace

double ToolGeometry::extent() const {
  return shape == ToolShape::Cylinder ? radius + 0.5 * length : radius;
}

std::string name_of(ToolShape shape) {
  switch (shape) {
    case ToolShape::Sphere:
      return "sphere";
    case ToolShape::Disc:
      return "disc";
    case ToolShape::Cylinder:
      return "cylinder";
  }
  return {};
}

std::string name_of(ToolFriction friction) {
  return friction == ToolFriction::NoSlip ? "no-slip" : "frictionless";
}

void check_tool(const ToolGeometry& g) {
  if (!(std::isfinite(g.radius) && g.radius > 0))
    refuse_size("tool_radius", g.radius, "a finite radius > 0", "");
  if (g.shape != ToolShape::Disc && g.edge_radius != 0)
    refuse_size("edge_radius", g.edge_radius, "no edge_radius", ": only a disc has an edge");
  if (!(g.edge_radius >= 0 && g.edge_radius <= g.radius))
    refuse_size("edge_radius", g.edge_radius, "0 (a sharp edge) to the radius", " of the disc");
  if (g.shape != ToolShape::Cylinder && g.length != 0)
    refuse_size("length", g.length, "no length", ": only a cylinder has a length");
  if (g.shape == ToolShape::Cylinder && !(std::isfinite(g.length) && g.length > 0))
    refuse_size("length", g.length, "a finite length > 0",
                " between the centres of the rounded ends");
}

double Tool::distance(const Vector3d& x) const {
  switch (geometry.shape) {
    case ToolShape::Sphere:
      return (x - tip + geometry.radius * inward).norm() - geometry.radius;
    case ToolShape::Cylinder:
      return (x - nearest_on_axis(*this, x).point).norm() - geometry.radius;
    case ToolShape::Disc: {
      const AtDisc p = at_disc(*this, x);
      const double from_core = p.out <= 0 ? p.below : std::hypot(p.out, std::max(p.below, 0.0));
      return from_core - geometry.edge_radius;
    }
  }
  return 0;
}

Gap Tool::gap(const Vector3d& x) const {
  switch (geometry.shape) {
    case ToolShape::Sphere:
      return round_gap(x - tip + geometry.radius * inward, Matrix3d::Identity(), geometry.radius);
    case ToolShape::Cylinder: {
      const OnAxis nearest = nearest_on_axis(*this, x);
      Matrix3d free = Matrix3d::Identity();
      if (!nearest.end) free -= axis * axis.transpose();
      return round_gap(x - nearest.point, free, geometry.radius);
    }
    case ToolShape::Disc:
      return disc_gap(*this, x);
  }
  return {};
}

}  // namespace palpate::fem
