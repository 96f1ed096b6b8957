// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/self_contact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace palpate::fem {

namespace {

using Cell = std::array<int, 3>;

Cell cell_of(const Eigen::Vector3d& x, double size) {
  return {static_cast<int>(std::floor(x[0] / size)), static_cast<int>(std::floor(x[1] / size)),
          static_cast<int>(std::floor(x[2] / size))};
}

/// The deformed corners of a tetrahedron.
Eigen::Matrix<double, 3, 4> corners(const QuadraticMesh& mesh, int element, const Displacement& u) {
  Eigen::Matrix<double, 3, 4> x;
  for (int c = 0; c < 4; ++c) {
    const int node = mesh.tetrahedra[to_index(element)][to_index(c)];
    x.col(c) = mesh.X.col(node) + u.col(node);
  }
  return x;
}

/// Inside by more than rounding.
bool contains(const Eigen::Matrix<double, 3, 4>& x, const Eigen::Vector3d& point) {
  Eigen::Matrix3d edges;
  for (int c = 0; c < 3; ++c) edges.col(c) = x.col(c + 1) - x.col(0);
  const Eigen::Vector3d L = edges.inverse() * (point - x.col(0));
  return L.minCoeff() > 1e-6 && L.sum() < 1 - 1e-6;
}

}  // namespace

SelfContact::SelfContact(const QuadraticMesh& mesh, const Eigen::Vector3d& centre, double reach)
    : mesh_(&mesh) {
  const auto near = [&](int node) { return (mesh.X.col(node) - centre).norm() <= reach; };
  std::map<int, std::set<int>> rings;
  for (const Facet& facet : mesh.facets)
    for (std::size_t c = 0; c < 3; ++c)
      if (near(facet[c])) rings[facet[c]];
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    const auto& node = mesh.tetrahedra[to_index(e)];
    if (!std::any_of(node.begin(), node.begin() + 4, near)) continue;
    tetrahedra_.push_back(e);
    for (std::size_t c = 0; c < 4; ++c) {
      const auto ring = rings.find(node[c]);
      if (ring != rings.end()) ring->second.insert(node.begin(), node.begin() + 4);
    }
  }
  for (auto& [node, ring] : rings) nodes_.push_back({node, {ring.begin(), ring.end()}});
}

int SelfContact::entering_node(const Displacement& u) const {
  double size =
      0;  // of a cell: the largest extent of a tetrahedron, so that each lies in few cells
  for (const int e : tetrahedra_) {
    const auto x = corners(*mesh_, e, u);
    size = std::max(size, (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff());
  }
  std::map<Cell, std::vector<int>> grid;
  for (const int e : tetrahedra_) {
    const auto x = corners(*mesh_, e, u);
    const Cell low = cell_of(x.rowwise().minCoeff(), size);
    const Cell high = cell_of(x.rowwise().maxCoeff(), size);
    for (int i = low[0]; i <= high[0]; ++i)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int k = low[2]; k <= high[2]; ++k) grid[{i, j, k}].push_back(e);
  }
  for (const Watched& watched : nodes_) {
    const Eigen::Vector3d point = mesh_->X.col(watched.node) + u.col(watched.node);
    const auto here = grid.find(cell_of(point, size));
    if (here == grid.end()) continue;
    for (const int e : here->second) {
      const auto& node = mesh_->tetrahedra[to_index(e)];
      const bool neighbour = std::any_of(node.begin(), node.begin() + 4, [&](int other) {
        return std::binary_search(watched.ring.begin(), watched.ring.end(), other);
      });
      if (!neighbour && contains(corners(*mesh_, e, u), point)) return watched.node;
    }
  }
  return -1;
}

}  // namespace palpate::fem
