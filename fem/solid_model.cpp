// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <numeric>

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
    : solid_(std::make_shared<Solid>(Solid{make_quadratic_mesh(body), std::move(laws)})) {
  std::vector<bool> free = mesh().held;
  free.flip();
  number_unknowns(free);
  std::vector<int> elements(mesh().tetrahedra.size());
  std::iota(elements.begin(), elements.end(), 0);
  take_elements(elements);
}

SolidModel::SolidModel(const SolidModel& whole, const Eigen::Vector3d& centre, double radius)
    : solid_(whole.solid_) {
  std::vector<bool> free(mesh().nodes());
  for (int node = 0; node < mesh().nodes(); ++node)
    free[node] =
        !mesh().held[node] && (mesh().X.col(node) - centre).squaredNorm() <= radius * radius;
  number_unknowns(free);
  std::vector<int> elements;
  for (int e = 0; e < static_cast<int>(mesh().tetrahedra.size()); ++e)
    if (std::ranges::any_of(mesh().tetrahedra[e], [&](int node) { return equation_[node] >= 0; }))
      elements.push_back(e);
  take_elements(elements);
}

void SolidModel::number_unknowns(const std::vector<bool>& free) {
  equation_.assign(mesh().nodes(), -1);
  for (int node = 0; node < mesh().nodes(); ++node) {
    if (!free[node]) continue;
    equation_[node] = unknowns_;
    unknowns_ += 3;
  }
}

void SolidModel::take_elements(const std::vector<int>& elements) {
  pattern_ = stiffness_pattern(mesh(), elements, equation_, unknowns_);
  make_blocks(elements);
  make_scatter();
}

void SolidModel::make_blocks(const std::vector<int>& elements) {
  for (int region = 0; region < static_cast<int>(solid_->laws.size()); ++region) {
    std::vector<int> members;
    for (const int e : elements)
      if (mesh().region[e] == region) members.push_back(e);
    for (std::size_t first = 0; first < members.size(); first += kLanes) {
      blocks_.push_back(make_block(members, first));
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
    const ElementGeometry<double> one = geometry_of(mesh(), block.element[lane]);
    block.geometry.volume[lane] = one.volume;
    for (int c = 0; c < 4; ++c)
      for (int j = 0; j < 3; ++j) block.geometry.gradient[c][j][lane] = one.gradient[c][j];
  }
  return block;
}

void SolidModel::make_scatter() {
  scatter_.assign(blocks_.size() * kElementEntries * kLanes, -1);
  int* place = scatter_.data();
  for (const Block& block : blocks_)
    for (int row = 0; row < 3 * kTetNodes; ++row)
      for (int column = 0; column <= row; ++column, place += kLanes)
        for (int lane = 0; lane < block.count; ++lane) {
          const auto& node = mesh().tetrahedra[block.element[lane]];
          const int i = equation_[node[row / 3]], j = equation_[node[column / 3]];
          if (i >= 0 && j >= 0) place[lane] = pattern_.position(i + row % 3, j + column % 3);
        }
}

ElementVector<Lanes> SolidModel::gather(const Block& block, const Displacement& u) const {
  ElementVector<Lanes> local;
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto& node = mesh().tetrahedra[block.element[lane]];
    for (int a = 0; a < kTetNodes; ++a)
      for (int i = 0; i < 3; ++i) local[a][i][lane] = u(i, node[a]);
  }
  return local;
}

void SolidModel::scatter(const Block& block, const ElementVector<Lanes>& forces,
                         Eigen::VectorXd& f) const {
  for (int lane = 0; lane < block.count; ++lane) {
    const auto& node = mesh().tetrahedra[block.element[lane]];
    for (int a = 0; a < kTetNodes; ++a) {
      const int first = equation_[node[a]];
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
    const Lanes energy = element_energy(solid_->laws[block.region], block.geometry, k);
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
    const NeoHookean& law = solid_->laws[block.region];
    state.energy += element_energy(law, block.geometry, k).head(block.count).sum();
    scatter(block, element_forces(law, block.geometry, k), f);
  }
  return state;
}

void SolidModel::stiffness(const Displacement& u, std::vector<double>& values) const {
  values.assign(pattern_.nonzeros(), 0.0);
  ElementMatrix<Lanes> K;
  const int* place = scatter_.data();
  for (const Block& block : blocks_) {
    const auto k = kinematics(block.geometry, gather(block, u));
    element_stiffness(solid_->laws[block.region], block.geometry, k, K);
    for (int entry = 0; entry < kElementEntries; ++entry, place += kLanes)
      for (int lane = 0; lane < block.count; ++lane)
        if (place[lane] >= 0) values[place[lane]] += K[entry][lane];
  }
}

void SolidModel::element_fields(const Displacement& u, std::vector<double>& energy_density,
                                std::vector<double>& pressure) const {
  energy_density.resize(mesh().tetrahedra.size());
  pressure.resize(mesh().tetrahedra.size());
  for (const Block& block : blocks_) {
    const NeoHookean& law = solid_->laws[block.region];
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
