// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/site_body.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Radius of the window over the tool radius. A wider one costs factorizations, a narrower one
/// solves.
constexpr double kWindowRadius = 2;

/// h_b: growth of the size of elements with the distance, outside the largest contact.
constexpr double kGrowthOutside = 0.5;
/// A bound on how often the contact divides an element.
constexpr int kMaxLevels = 12;

using Corners = std::array<Eigen::Vector3d, 4>;

/// Distance of a point from a segment.
double distance(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double fraction = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + fraction * (b - a) - x).norm();
}

/// Distance of a point from a triangle: from its plane where it lies above it, else from its edges.
double distance(const Eigen::Vector3d& x, const std::array<Eigen::Vector3d, 3>& corner) {
  const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
  double nearest = std::numeric_limits<double>::infinity();
  bool above = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d &from = corner[i], &to = corner[(i + 1) % 3];
    above = above && (to - from).cross(x - from).dot(normal) >= 0;
    nearest = std::min(nearest, distance(x, from, to));
  }
  return above ? std::abs((x - corner[0]).dot(normal)) : nearest;
}

/// Distance of a point outside of a tetrahedron, or on its boundary.
double distance(const Eigen::Vector3d& x, const Corners& corner) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t without = 0; without < 4; ++without)
    nearest = std::min(nearest,
                       distance(x, std::array{corner[(without + 1) % 4], corner[(without + 2) % 4],
                                              corner[(without + 3) % 4]}));
  return nearest;
}

/// The elements behind the facets within `reach` of a point, and those with three corners among the
/// corners of these facets.
std::vector<int> elements_near(const QuadraticMesh& mesh, const Eigen::Vector3d& site,
                               double reach) {
  std::vector<bool> corner_of_near(to_index(mesh.nodes()), false);
  for (const Facet& f : mesh.facets)
    if (distance(site, std::array<Eigen::Vector3d, 3>{mesh.X.col(f[0]), mesh.X.col(f[1]),
                                                      mesh.X.col(f[2])}) <= reach)
      for (std::size_t c = 0; c < 3; ++c) corner_of_near[to_index(f[c])] = true;
  std::vector<int> elements;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    const Tetrahedron10& t = mesh.tetrahedra[to_index(e)];
    const auto near = [&](int node) { return corner_of_near[to_index(node)]; };
    if (std::count_if(t.begin(), t.begin() + 4, near) >= 3) elements.push_back(e);
  }
  return elements;
}

RefinedMesh refined_by_levels(const QuadraticMesh& mesh, const Eigen::Vector3d& site, double reach,
                              int levels) {
  const auto near = [&](const Corners& corners, int level) {
    return distance(site, corners) <= std::ldexp(reach, -level);
  };
  return refine_elements(mesh, elements_near(mesh, site, reach), levels, near);
}

/// The edge of the regular tetrahedron with the same sum of squared edges.
double size_of(const Corners& corner) {
  double squares = 0;
  for (const auto& [i, j] : kTetEdges) squares += (corner[i] - corner[j]).squaredNorm();
  return std::sqrt(squares / 6);
}

RefinedMesh refined_by_contact(const QuadraticMesh& mesh, const Eigen::Vector3d& site,
                               const SiteRefinement& refinement) {
  const auto too_large = [&](const Corners& corners, int) {
    // The site lies within twice its size from the centre of an element that it touches.
    const double size = size_of(corners);
    const auto allowed = [&](double s) {
      return refinement.size_over_distance * std::max(refinement.min_contact_radius, s) +
             kGrowthOutside * std::max(0.0, s - refinement.max_contact_radius);
    };
    const Eigen::Vector3d centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    if (size <= allowed(std::max(0.0, (site - centre).norm() - 2 * size))) return false;
    return size > allowed(distance(site, corners));
  };
  std::vector<int> elements;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    const Tetrahedron10& t = mesh.tetrahedra[to_index(e)];
    if (too_large({mesh.X.col(t[0]), mesh.X.col(t[1]), mesh.X.col(t[2]), mesh.X.col(t[3])}, 0))
      elements.push_back(e);
  }
  return refine_elements(mesh, elements, kMaxLevels, too_large);
}

}  // namespace

double window_radius(const ToolGeometry& tool) {
  return tool.extent() + (kWindowRadius - 1) * tool.radius;
}

SolidModel window_at(const SolidModel& body, const Eigen::Vector3d& site,
                     const ToolGeometry& tool) {
  return {body, site, window_radius(tool)};
}

SiteBody::SiteBody(const SolidModel& body, const Displacement& rest, const Eigen::Vector3d& site,
                   const ToolGeometry& tool, SiteMesh mesh, const SiteRefinement& refinement)
    : whole_(&body), rest_(rest) {
  if (mesh == SiteMesh::Window) window_.emplace(window_at(body, site, tool));
  if (mesh == SiteMesh::RefinedWindow) refine(site, tool, refinement);
}

/// The window has every new node and the nodes of its parent: seen from outside the window, the
/// refined body at rest is then nearly the one that was factorized.
void SiteBody::refine(const Eigen::Vector3d& site, const ToolGeometry& tool,
                      const SiteRefinement& refinement) {
  const QuadraticMesh& mesh = whole_->mesh();
  RefinedMesh refined = refinement.min_contact_radius > 0
                            ? refined_by_contact(mesh, site, refinement)
                            : refined_by_levels(mesh, site, tool.extent(), refinement.levels);
  std::vector<bool> free = nodes_within(mesh, site, window_radius(tool));
  for (const RefinedMesh::NewNode& node : refined.new_nodes)
    for (const int neighbour : mesh.tetrahedra[to_index(node.parent)])
      free[to_index(neighbour)] = true;
  free.resize(free.size() + refined.new_nodes.size(), true);
  refined_.emplace(SolidModel::without_stiffness(*whole_, std::move(refined.mesh)));
  window_.emplace(*refined_, std::move(free));
  prolongation_.emplace(refined, mesh.tetrahedra, *refined_);
  rest_.conservativeResize(Eigen::NoChange, refined_->mesh().nodes());
  rest_.rightCols(refined_->mesh().nodes() - mesh.nodes()).setZero();
}

double SiteBody::bytes() const {
  return (window_ ? window_->bytes() : 0) + (refined_ ? refined_->bytes() : 0);
}

}  // namespace palpate::fem
