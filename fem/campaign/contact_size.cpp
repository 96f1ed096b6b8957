// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/contact_size.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Bounds of R'/R.
constexpr double kSmallestRatio = 0.25, kLargestRatio = 4;
/// Least distance of the edge of a disc from its ring, over the radius: a sharper fillet is not
/// resolved, since the force of a punch hardly knows it.
constexpr double kLeastFillet = 0.08;
/// Cosine between the normal of a facet and the outward direction from which on it faces the tool.
constexpr double kFacing = 0.5;

double distance_of_edge(double radius, double curvature, double depth) {
  const double ratio =
      1 / std::clamp(1 + radius * curvature, 1 / kLargestRatio, 1 / kSmallestRatio);
  return std::sqrt(ratio * radius * depth);
}

std::vector<bool> facing_nodes(const QuadraticMesh& mesh, const Eigen::Vector3d& inward) {
  std::vector<bool> facing(to_index(mesh.nodes()), false);
  for (const Facet& f : mesh.facets) {
    const Eigen::Vector3d normal = Eigen::Vector3d(mesh.X.col(f[1]) - mesh.X.col(f[0]))
                                       .cross(Eigen::Vector3d(mesh.X.col(f[2]) - mesh.X.col(f[0])))
                                       .normalized();
    if (normal.dot(inward) > -kFacing) continue;
    for (const int node : f)
      if (node >= 0) facing[to_index(node)] = true;
  }
  return facing;
}

ContactCore ring_of(const Tool& tool, const SurfaceCurvature& curvature, double first,
                    double last) {
  const ToolGeometry& g = tool.geometry;
  const double fillet =
      std::max(g.edge_radius, kLeastFillet * kLeastFillet * g.radius * g.radius / first);
  ContactCore ring;
  ring.centre = tool.tip;
  ring.inward = tool.inward;
  ring.ring_radius = g.radius - g.edge_radius;
  ring.ring_sag = 0.5 * curvature.mean() * ring.ring_radius * ring.ring_radius;
  ring.smallest = std::sqrt(fillet * first);
  ring.largest = std::max(ring.smallest, std::sqrt(g.edge_radius * last));
  return ring;
}

}  // namespace

Eigen::Vector3d ContactCore::nearest(const Eigen::Vector3d& x) const {
  if (ring_radius > 0) {
    const Eigen::Vector3d across = x - centre - (x - centre).dot(inward) * inward;
    const double length = across.norm();
    const Eigen::Vector3d out =
        length > 0 ? Eigen::Vector3d(across / length) : inward.unitOrthogonal();
    return centre + ring_radius * out + ring_sag * inward;
  }
  const double squared = half_axis.squaredNorm();
  if (squared == 0) return centre;
  return centre + std::clamp((x - centre).dot(half_axis) / squared, -1.0, 1.0) * half_axis;
}

SurfaceCurvature curvature_at(const QuadraticMesh& mesh, const Eigen::Vector3d& point,
                              const Eigen::Vector3d& inward, const Eigen::Vector3d& first,
                              const Eigen::Vector3d& second, double reach) {
  const std::vector<bool> facing = facing_nodes(mesh, inward);
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
  int nodes = 0;
  for (int node = 0; node < mesh.nodes(); ++node) {
    const Eigen::Vector3d away = mesh.X.col(node) - point;
    if (!facing[to_index(node)] || away.norm() > reach) continue;
    // In units of the reach, so that the equations are well scaled.
    const double x = away.dot(first) / reach, y = away.dot(second) / reach;
    Eigen::Matrix<double, 6, 1> row;
    row << 1, x, y, 0.5 * x * x, x * y, 0.5 * y * y;
    A += row * row.transpose();
    b += row * (away.dot(inward) / reach);
    ++nodes;
  }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(A);
  if (nodes < 6 || factor.vectorD().minCoeff() < 1e-9 * nodes) return {};
  const Eigen::Matrix<double, 6, 1> c = factor.solve(b) / reach;
  return {c[3], c[4], c[5]};
}

std::vector<ContactCore> contact_cores(const QuadraticMesh& mesh, const Tool& tool,
                                       double first_depth, double last_depth) {
  const ToolGeometry& g = tool.geometry;
  if (tool.has_sharp_edge()) return {};
  const Eigen::Vector3d across = tool.inward.cross(tool.axis);
  const SurfaceCurvature curvature =
      curvature_at(mesh, tool.tip, tool.inward, tool.axis, across, 1.5 * g.extent());
  ContactCore core;
  core.centre = tool.tip;
  core.inward = tool.inward;
  const auto set_edge = [&](double radius, double k) {
    core.smallest = distance_of_edge(radius, k, first_depth);
    core.largest = distance_of_edge(radius, k, last_depth);
  };
  if (g.shape == ToolShape::Sphere) {
    set_edge(g.radius, curvature.mean());
    return {core};
  }
  if (g.shape == ToolShape::Cylinder) {
    core.half_axis = 0.5 * g.length * tool.axis;
    set_edge(g.radius, curvature.k22);
    return {core};
  }
  const ContactCore ring = ring_of(tool, curvature, first_depth, last_depth);
  if (!(ring.ring_sag > first_depth)) return {ring};
  core.smallest = std::sqrt(first_depth / curvature.mean());
  core.largest = ring.ring_radius;
  return {core, ring};
}

}  // namespace palpate::fem
