// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid_model.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace palpate::fem {

namespace {

constexpr int kElementEntries = static_cast<int>(std::tuple_size_v<ElementMatrix<double>>);

/// Volume and gradients of the volume coordinates of one straight tetrahedron.
ElementGeometry<double> geometry_of(const QuadraticMesh& mesh, int element) {
  const auto& node = mesh.tetrahedra[element];
  Eigen::Matrix3d edges;
  for (int c = 0; c < 3; ++c) edges.col(c) = mesh.X.col(node[c + 1]) - mesh.X.col(node[0]);
  const Eigen::Matrix3d inverse = edges.inverse();  // rows: gradients of L_1, L_2, L_3
  ElementGeometry<double> geometry;
  geometry.volume = edges.determinant() / 6;
  for (int j = 0; j < 3; ++j) {
    for (int c = 0; c < 3; ++c) geometry.gradient[c + 1][j] = inverse(c, j);
    geometry.gradient[0][j] = -inverse.col(j).sum();
  }
  return geometry;
}

}  // namespace

SolidModel::SolidModel(const Body& body, std::vector<NeoHookean> laws)
    : mesh_(make_quadratic_mesh(body)), laws_(std::move(laws)), pattern_(stiffness_pattern(mesh_)) {
  make_blocks();
  make_scatter();
}

void SolidModel::make_blocks() {
  for (int region = 0; region < static_cast<int>(laws_.size()); ++region) {
    std::vector<int> elements;
    for (int e = 0; e < static_cast<int>(mesh_.tetrahedra.size()); ++e)
      if (mesh_.region[e] == region) elements.push_back(e);
    for (std::size_t first = 0; first < elements.size(); first += kLanes) {
      blocks_.push_back(make_block(elements, first));
      blocks_.back().region = region;
    }
  }
}

SolidModel::Block SolidModel::make_block(const std::vector<int>& elements,
                                         std::size_t first) const {
  Block block;
  block.count = static_cast<int>(std::min<std::size_t>(kLanes, elements.size() - first));
  for (int lane = 0; lane < kLanes; ++lane) {
    block.element[lane] = elements[std::min(first + lane, elements.size() - 1)];
    const ElementGeometry<double> one = geometry_of(mesh_, block.element[lane]);
    block.geometry.volume[lane] = one.volume;
    for (int c = 0; c < 4; ++c)
      for (int j = 0; j < 3; ++j) block.geometry.gradient[c][j][lane] = one.gradient[c][j];
  }
  return block;
}

void SolidModel::make_scatter() {
  scatter_.assign(mesh_.tetrahedra.size() * kElementEntries, -1);
  for (std::size_t e = 0; e < mesh_.tetrahedra.size(); ++e)
    for (int row = 0; row < 3 * kTetNodes; ++row)
      for (int column = 0; column <= row; ++column) {
        const int i = mesh_.equation[mesh_.tetrahedra[e][row / 3]];
        const int j = mesh_.equation[mesh_.tetrahedra[e][column / 3]];
        if (i < 0 || j < 0) continue;
        scatter_[e * kElementEntries + lower_index(row, column)] =
            pattern_.position(i + row % 3, j + column % 3);
      }
}

ElementVector<Lanes> SolidModel::gather(const Block& block, const Displacement& u) const {
  ElementVector<Lanes> local;
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto& node = mesh_.tetrahedra[block.element[lane]];
    for (int a = 0; a < kTetNodes; ++a)
      for (int i = 0; i < 3; ++i) local[a][i][lane] = u(i, node[a]);
  }
  return local;
}

void SolidModel::scatter(const Block& block, const ElementVector<Lanes>& forces,
                         Eigen::VectorXd& f) const {
  for (int lane = 0; lane < block.count; ++lane) {
    const auto& node = mesh_.tetrahedra[block.element[lane]];
    for (int a = 0; a < kTetNodes; ++a) {
      const int first = mesh_.equation[node[a]];
      if (first < 0) continue;
      for (int i = 0; i < 3; ++i) f[first + i] += forces[a][i][lane];
    }
  }
}

namespace {

double smallest(const ElementKinematics<Lanes>& k) {
  return std::min({k.J[0].minCoeff(), k.J[1].minCoeff(), k.J[2].minCoeff(), k.J[3].minCoeff()});
}

}  // namespace

SolidModel::State SolidModel::energy(const Displacement& u) const {
  State state;
  for (const Block& block : blocks_) {
    const auto k = kinematics(block.geometry, gather(block, u));
    state.min_J = std::min(state.min_J, smallest(k));
    if (!(state.min_J > 0)) return state;
    const Lanes energy = element_energy(laws_[block.region], block.geometry, k);
    state.energy += energy.head(block.count).sum();
  }
  return state;
}

SolidModel::State SolidModel::forces(const Displacement& u, Eigen::VectorXd& f) const {
  State state;
  f.setZero(pattern_.n);
  for (const Block& block : blocks_) {
    const auto k = kinematics(block.geometry, gather(block, u));
    state.min_J = std::min(state.min_J, smallest(k));
    if (!(state.min_J > 0)) return state;
    const NeoHookean& law = laws_[block.region];
    state.energy += element_energy(law, block.geometry, k).head(block.count).sum();
    scatter(block, element_forces(law, block.geometry, k), f);
  }
  return state;
}

void SolidModel::stiffness(const Displacement& u, std::vector<double>& values) const {
  values.assign(pattern_.nonzeros(), 0.0);
  ElementMatrix<Lanes> K;
  for (const Block& block : blocks_) {
    const auto k = kinematics(block.geometry, gather(block, u));
    element_stiffness(laws_[block.region], block.geometry, k, K);
    for (int lane = 0; lane < block.count; ++lane) {
      const int* place =
          scatter_.data() + static_cast<std::size_t>(block.element[lane]) * kElementEntries;
      for (int entry = 0; entry < kElementEntries; ++entry)
        if (place[entry] >= 0) values[place[entry]] += K[entry][lane];
    }
  }
}

void SolidModel::element_fields(const Displacement& u, std::vector<double>& energy_density,
                                std::vector<double>& pressure) const {
  energy_density.resize(mesh_.tetrahedra.size());
  pressure.resize(mesh_.tetrahedra.size());
  for (const Block& block : blocks_) {
    const NeoHookean& law = laws_[block.region];
    const auto k = kinematics(block.geometry, gather(block, u));
    const Lanes density = element_energy(law, block.geometry, k) / block.geometry.volume;
    const Lanes p = law.pressure(k.mean_J);
    for (int lane = 0; lane < block.count; ++lane) {
      energy_density[block.element[lane]] = density[lane];
      pressure[block.element[lane]] = p[lane];
    }
  }
}

}  // namespace palpate::fem
