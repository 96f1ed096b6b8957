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

/// A bound on how often the contact divides an element.
constexpr int kMaxLevels = 12;

using TetCorners = std::array<Eigen::Vector3d, 4>;

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
double distance(const Eigen::Vector3d& x, const TetCorners& corner) {
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

/// The edge of the regular tetrahedron with the same sum of squared edges.
double size_of(const TetCorners& corner) {
  double squares = 0;
  for (const auto& [i, j] : kTetEdges) squares += (corner[i] - corner[j]).squaredNorm();
  return std::sqrt(squares / 6);
}

/// Which elements the refinement divides, and how often.
class Division {
 public:
  Division(const QuadraticMesh& mesh, const Eigen::Vector3d& site, double reach,
           const SiteRefinement& refinement)
      : mesh_(mesh), site_(site), reach_(reach), refinement_(refinement) {}

  RefinedMesh refined() const {
    const bool by_contact = !refinement_.cores.empty();
    std::vector<int> elements;
    if (refinement_.levels > 0) elements = elements_near(mesh_, site_, reach_);
    if (by_contact) add_too_large(elements);
    return refine_elements(mesh_, elements, by_contact ? kMaxLevels : refinement_.levels,
                           [this](const TetCorners& corners, int level) {
                             return asked_by_levels(corners, level) || too_large(corners);
                           });
  }

 private:
  void add_too_large(std::vector<int>& elements) const {
    for (int e = 0; e < static_cast<int>(mesh_.tetrahedra.size()); ++e) {
      const Tetrahedron10& t = mesh_.tetrahedra[to_index(e)];
      if (too_large({mesh_.X.col(t[0]), mesh_.X.col(t[1]), mesh_.X.col(t[2]), mesh_.X.col(t[3])}))
        elements.push_back(e);
    }
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  }

  bool asked_by_levels(const TetCorners& corners, int level) const {
    if (level >= refinement_.levels) return false;
    const int halvings = std::max(0, level - (refinement_.first_levels - 1));
    return distance(site_, corners) <= std::ldexp(reach_, -halvings);
  }

  double allowed_size(const ContactCore& core, double s) const {
    return refinement_.size_over_distance * std::max(core.smallest, std::min(s, core.largest / 2)) +
           refinement_.growth_outside * std::max(0.0, s - core.largest);
  }

  bool too_large(const TetCorners& corners) const {
    return std::any_of(refinement_.cores.begin(), refinement_.cores.end(),
                       [&](const ContactCore& core) { return too_large(corners, core); });
  }

  bool too_large(const TetCorners& corners, const ContactCore& core) const {
    const double size = size_of(corners);
    const Eigen::Vector3d centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    const Eigen::Vector3d nearest = core.nearest(centre);
    // The line lies within twice its size from the centre of an element that it touches.
    const double least = std::max(0.0, (nearest - centre).norm() - 2 * size);
    if (size <= allowed_size(core, least)) return false;
    return size > allowed_size(core, distance(nearest, corners));
  }

  const QuadraticMesh& mesh_;
  Eigen::Vector3d site_;
  double reach_;
  SiteRefinement refinement_;
};

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
  const RefinedMesh refined = Division(mesh, site, tool.extent(), refinement).refined();
  std::vector<bool> free = nodes_within(mesh, site, window_radius(tool));
  for (const RefinedMesh::NewNode& node : refined.new_nodes)
    for (const int neighbour : mesh.tetrahedra[to_index(node.parent)])
      free[to_index(neighbour)] = true;
  free.resize(free.size() + refined.new_nodes.size(), true);
  refined_.emplace(SolidModel::without_stiffness(*whole_, refined));
  window_.emplace(*refined_, std::move(free));
  prolongation_.emplace(refined, mesh.tetrahedra, *refined_);
  rest_.conservativeResize(Eigen::NoChange, refined_->mesh().nodes());
  for (std::size_t i = 0; i < refined.new_nodes.size(); ++i) {
    const RefinedMesh::NewNode& added = refined.new_nodes[i];
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    for (std::size_t a = 0; a < kTetNodes; ++a)
      moved += added.N[a] * rest_.col(mesh.tetrahedra[to_index(added.parent)][a]);
    rest_.col(mesh.nodes() + static_cast<Eigen::Index>(i)) = moved;
  }
}

double SiteBody::bytes() const {
  return (window_ ? window_->bytes() : 0) + (refined_ ? refined_->bytes() : 0);
}

}  // namespace palpate::fem
