// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/site_body.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Distance of a point from a segment.
double distance(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double share = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + share * (b - a) - x).norm();
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

/// The elements behind the facets that come within `reach` of a point, and those that share three
/// corners with these facets.
std::vector<int> elements_near(const QuadraticMesh& mesh, const Eigen::Vector3d& site,
                               double reach) {
  std::vector<bool> corner_of_near(to_index(mesh.nodes()), false);
  for (const Facet& f : mesh.facets)
    if (distance(site, {mesh.X.col(f[0]), mesh.X.col(f[1]), mesh.X.col(f[2])}) <= reach)
      for (std::size_t c = 0; c < 3; ++c) corner_of_near[to_index(f[c])] = true;
  std::vector<int> elements;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    const Tetrahedron10& t = mesh.tetrahedra[to_index(e)];
    const auto near = [&](int node) { return corner_of_near[to_index(node)]; };
    if (std::count_if(t.begin(), t.begin() + 4, near) >= 3) elements.push_back(e);
  }
  return elements;
}

}  // namespace

SiteBody::SiteBody(const CampaignContext& context, const Eigen::Vector3d& site)
    : whole_(&context.model), rest_(context.rest) {
  if (context.engine == Engine::Direct) return;
  if (!context.indentation.refine_under_tool) {
    window_.emplace(window_at(context, site));
    return;
  }
  // All that is divided belongs to the window, and an element around it: seen from outside the
  // window, the body at rest is then still nearly the one that was factorized.
  const QuadraticMesh& mesh = context.model.mesh();
  const double reach = context.indentation.tool.extent();
  RefinedMesh divided = divide(mesh, elements_near(mesh, site, reach));
  std::vector<bool> free = nodes_within(mesh, site, window_radius(context));
  for (const RefinedMesh::Made& made : divided.made)
    for (const int node : mesh.tetrahedra[to_index(made.parent)]) free[to_index(node)] = true;
  free.resize(free.size() + divided.made.size(), true);
  refined_.emplace(SolidModel::without_stiffness(context.model, std::move(divided.mesh)));
  window_.emplace(*refined_, std::move(free));
  prolongation_.emplace(divided, mesh.tetrahedra, *refined_);
  rest_.conservativeResize(Eigen::NoChange, refined_->mesh().nodes());
  rest_.rightCols(refined_->mesh().nodes() - mesh.nodes()).setZero();
}

double SiteBody::bytes() const {
  return (window_ ? window_->bytes() : 0) + (refined_ ? refined_->bytes() : 0);
}

}  // namespace palpate::fem
