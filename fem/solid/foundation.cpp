// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/foundation.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

using FacetMass = Eigen::Matrix<double, 6, 6>;

/// Integrals of N_a N_b over a straight facet of area 1: corners 0..2, then the edges 01, 12, 20.
FacetMass quadratic_mass() {
  FacetMass M;
  M << 6, -1, -1, 0, -4, 0,  //
      -1, 6, -1, 0, 0, -4,   //
      -1, -1, 6, -4, 0, 0,   //
      0, 0, -4, 32, 16, 16,  //
      -4, 0, 0, 16, 32, 16,  //
      0, -4, 0, 16, 16, 32;
  return M / 180;
}

/// The same for linear shape functions of the corners.
FacetMass linear_mass() {
  FacetMass M = FacetMass::Zero();
  M.topLeftCorner<3, 3>() << 2, 1, 1, 1, 2, 1, 1, 1, 2;
  return M / 12;
}

}  // namespace

Foundation::Foundation(const QuadraticMesh& mesh, const std::vector<int>& equation)
    : mass_(mesh.linear ? linear_mass() : quadratic_mass()) {
  for (const SprungFacet& sprung : mesh.sprung) {
    const Facet& nodes = mesh.facets[to_index(sprung.facet)];
    if (std::ranges::all_of(nodes, [&](int node) { return equation[to_index(node)] < 0; }))
      continue;
    const Eigen::Vector3d a = mesh.X.col(nodes[1]) - mesh.X.col(nodes[0]),
                          b = mesh.X.col(nodes[2]) - mesh.X.col(nodes[0]);
    const Eigen::Vector3d N = a.cross(b).normalized();
    const Eigen::Matrix3d along = N * N.transpose();
    springs_.push_back({nodes, 0.5 * a.cross(b).norm(),
                        sprung.normal_stiffness * along +
                            sprung.tangential_stiffness * (Eigen::Matrix3d::Identity() - along)});
  }
}

double Foundation::energy(const Eigen::Matrix3Xd& u) const {
  double sum = 0;
  for (const Spring& spring : springs_) {
    Eigen::Matrix<double, 3, 6> local;
    for (int a = 0; a < 6; ++a) local.col(a) = u.col(spring.nodes[to_index(a)]);
    sum += 0.5 * spring.area * (spring.per_area * local * mass_).cwiseProduct(local).sum();
  }
  return sum;
}

void Foundation::add_forces(const std::vector<int>& equation, const Eigen::Matrix3Xd& u,
                            Eigen::VectorXd& f) const {
  for (const Spring& spring : springs_) {
    Eigen::Matrix<double, 3, 6> local;
    for (int a = 0; a < 6; ++a) local.col(a) = u.col(spring.nodes[to_index(a)]);
    const Eigen::Matrix<double, 3, 6> forces = spring.area * (spring.per_area * local * mass_);
    for (int a = 0; a < 6; ++a)
      if (const int first = equation[to_index(spring.nodes[to_index(a)])]; first >= 0)
        f.segment<3>(first) += forces.col(a);
  }
}

void Foundation::add_stiffness(const std::vector<int>& equation, const SparsePattern& pattern,
                               std::vector<double>& values) const {
  for (const Spring& spring : springs_)
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) {
        const int row = equation[to_index(spring.nodes[to_index(a)])],
                  column = equation[to_index(spring.nodes[to_index(b)])];
        if (row < 0 || column < 0 || mass_(a, b) == 0) continue;
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k)
            if (row + i >= column + k)
              values[to_index(pattern.position(row + i, column + k))] +=
                  spring.area * mass_(a, b) * spring.per_area(i, k);
      }
}

}  // namespace palpate::fem
