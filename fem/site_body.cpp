// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/site_body.hpp"

#include <algorithm>

#include "fem/at.hpp"

namespace palpate::fem {

namespace {

std::vector<int> elements_at(const QuadraticMesh& mesh, const std::vector<bool>& nodes) {
  std::vector<int> elements;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e)
    if (std::ranges::any_of(mesh.tetrahedra[at(e)], [&](int node) { return nodes[at(node)]; }))
      elements.push_back(e);
  return elements;
}

}  // namespace

SiteBody::SiteBody(const CampaignContext& context, const Eigen::Vector3d& site)
    : whole_(&context.model), rest_(context.rest) {
  if (context.engine == Engine::Direct) return;
  if (!context.indentation.divide_under_tool) {
    window_.emplace(window_at(context, site));
    return;
  }
  // All that is divided belongs to the window, and an element around it: seen from outside the
  // window, the body at rest is then still nearly the one that was factorized.
  const QuadraticMesh& mesh = context.model.mesh();
  const double reach = context.indentation.tool.extent();
  DividedMesh divided = divide(mesh, elements_at(mesh, nodes_within(mesh, site, reach)));
  std::vector<bool> free = nodes_within(mesh, site, window_radius(context));
  for (const DividedMesh::Made& made : divided.made)
    for (const int node : mesh.tetrahedra[at(made.parent)]) free[at(node)] = true;
  free.resize(free.size() + divided.made.size(), true);
  divided_.emplace(SolidModel::without_stiffness(context.model, std::move(divided.mesh)));
  window_.emplace(*divided_, std::move(free));
  prolongation_.emplace(divided, mesh.tetrahedra, *divided_);
  rest_.conservativeResize(Eigen::NoChange, divided_->mesh().nodes());
  rest_.rightCols(divided_->mesh().nodes() - mesh.nodes()).setZero();
}

double SiteBody::bytes() const {
  return (window_ ? window_->bytes() : 0) + (divided_ ? divided_->bytes() : 0);
}

}  // namespace palpate::fem
