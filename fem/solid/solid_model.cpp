// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/solid_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <numeric>

#include "fem/mesh/to_eigen.hpp"

namespace palpate::fem {

namespace {

/// Volume and gradients of the volume coordinates of one straight tetrahedron.
ElementGeometry<double> geometry_of(const QuadraticMesh& mesh, int element) {
  const auto& node = mesh.tetrahedra[to_index(element)];
  Eigen::Matrix3d edges;
  for (int c = 0; c < 3; ++c)
    edges.col(c) = mesh.X.col(node[to_index(c + 1)]) - mesh.X.col(node[0]);
  const Eigen::Matrix3d inverse = edges.inverse();  // rows: gradients of L_1, L_2, L_3
  ElementGeometry<double> geometry;
  geometry.volume = volume_of(mesh, element);
  for (int j = 0; j < 3; ++j) {
    for (int c = 0; c < 3; ++c) geometry.gradient[to_index(c + 1)][to_index(j)] = inverse(c, j);
    geometry.gradient[0][to_index(j)] = -inverse.col(j).sum();
  }
  return geometry;
}

/// Integral of N_a over an element of volume 1.
double shape_integral(std::size_t a, bool linear) {
  if (linear) return a < 4 ? 0.25 : 0;
  return a < 4 ? -0.05 : 0.2;
}

Eigen::Matrix3Xd nodal_weight(const QuadraticMesh& mesh, const Gravity& gravity) {
  if (!gravity.acts()) return {};
  Eigen::Matrix3Xd weight = Eigen::Matrix3Xd::Zero(3, mesh.nodes());
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    const Eigen::Vector3d per_volume =
        gravity.density_of(mesh.region[to_index(e)]) * to_eigen(gravity.acceleration);
    for (std::size_t a = 0; a < kTetNodes; ++a)
      weight.col(mesh.tetrahedra[to_index(e)][a]) +=
          volume_of(mesh, e) * shape_integral(a, mesh.linear) * per_volume;
  }
  return weight;
}

std::shared_ptr<const Solid> make_solid(const Body& body, std::vector<Law> laws,
                                        Dilatation dilatation, const Gravity& gravity,
                                        std::vector<std::array<Vec3, 2>> fibres) {
  auto solid = std::make_shared<Solid>(Solid{make_quadratic_mesh(body, is_linear(dilatation)),
                                             std::move(laws),
                                             dilatation,
                                             gravity,
                                             {},
                                             std::move(fibres)});
  solid->weight = nodal_weight(solid->mesh, gravity);
  return solid;
}

/// The same body on a refined mesh; children have the fibres of their parents.
std::shared_ptr<const Solid> refined_solid(const Solid& whole, const RefinedMesh& refined) {
  Solid solid{refined.mesh, whole.laws, whole.dilatation, whole.gravity, {}, {}};
  solid.weight = nodal_weight(solid.mesh, solid.gravity);
  if (!whole.fibres.empty())
    for (const std::int32_t parent : refined.parent)
      solid.fibres.push_back(whole.fibres[to_index(parent)]);
  return std::make_shared<const Solid>(std::move(solid));
}

}  // namespace

SolidModel::SolidModel(const Body& body, std::vector<Law> laws, Dilatation dilatation,
                       const Gravity& gravity, std::vector<std::array<Vec3, 2>> fibres)
    : solid_(make_solid(body, std::move(laws), dilatation, gravity, std::move(fibres))) {
  std::vector<bool> free(to_index(mesh().nodes()));
  for (int node = 0; node < mesh().nodes(); ++node) free[to_index(node)] = mesh().is_free(node);
  number_unknowns(free);
  std::vector<int> elements(mesh().tetrahedra.size());
  std::iota(elements.begin(), elements.end(), 0);
  take_elements(elements);
}

std::vector<bool> nodes_within(const QuadraticMesh& mesh, const Eigen::Vector3d& centre,
                               double radius) {
  std::vector<bool> within(to_index(mesh.nodes()));
  for (int node = 0; node < mesh.nodes(); ++node)
    within[to_index(node)] = (mesh.X.col(node) - centre).squaredNorm() <= radius * radius;
  return within;
}

SolidModel::SolidModel(const SolidModel& whole, const Eigen::Vector3d& centre, double radius)
    : SolidModel(whole, nodes_within(whole.mesh(), centre, radius)) {}

SolidModel::SolidModel(const SolidModel& whole, std::vector<bool> free) : solid_(whole.solid_) {
  for (std::size_t node = 0; node < free.size(); ++node)
    free[node] = free[node] && mesh().is_free(static_cast<int>(node));
  number_unknowns(free);
  std::vector<int> elements;
  for (int e = 0; e < static_cast<int>(mesh().tetrahedra.size()); ++e)
    if (std::ranges::any_of(mesh().tetrahedra[to_index(e)],
                            [&](int node) { return equation(node) >= 0; }))
      elements.push_back(e);
  take_elements(elements);
}

SolidModel SolidModel::without_stiffness(const SolidModel& whole, const RefinedMesh& refined) {
  SolidModel model(refined_solid(*whole.solid_, refined));
  std::vector<bool> free = model.mesh().fixed;
  free.flip();
  model.number_unknowns(free);
  std::vector<int> elements(model.mesh().tetrahedra.size());
  std::iota(elements.begin(), elements.end(), 0);
  if (has_nodal_pressure(whole.solid_->dilatation))
    model.nodal_ = NodalPressure(model.mesh(), elements, model.equation_);
  model.make_blocks(elements);
  model.foundation_ = Foundation(model.mesh(), model.equation_);
  model.pattern_.n = model.unknowns_;
  return model;
}

SolidModel SolidModel::relaxing(const SolidModel& body, const HistoryStress* step) {
  SolidModel model = body;
  model.step_ = step;
  return model;
}

Eigen::VectorXd SolidModel::weight() const {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(unknowns_);
  if (solid_->weight.cols() == 0) return load;
  for (int node = 0; node < mesh().nodes(); ++node)
    if (equation(node) >= 0) load.segment<3>(equation(node)) = solid_->weight.col(node);
  return load;
}

double SolidModel::bytes() const {
  return static_cast<double>(blocks_.size() * sizeof(Block) +
                             sizeof(int) * (scatter_.size() + equation_.size() +
                                            pattern_.row.size() + pattern_.start.size()) +
                             nodal_.bytes() + foundation_.bytes());
}

void SolidModel::number_unknowns(const std::vector<bool>& free) {
  equation_.assign(to_index(mesh().nodes()), -1);
  for (int node = 0; node < mesh().nodes(); ++node) {
    if (!free[to_index(node)]) continue;
    equation_[to_index(node)] = unknowns_;
    unknowns_ += 3;
  }
}

void SolidModel::take_elements(const std::vector<int>& elements) {
  std::vector<std::span<const std::int32_t>> coupled;
  if (has_nodal_pressure(solid_->dilatation)) {
    nodal_ = NodalPressure(mesh(), elements, equation_);
    for (const NodalPressure::Point& point : nodal_.points()) coupled.emplace_back(point.nodes);
    make_blocks(nodal_.elements());
  } else {
    for (const int e : elements) coupled.emplace_back(mesh().tetrahedra[to_index(e)]);
    make_blocks(elements);
  }
  foundation_ = Foundation(mesh(), equation_);
  pattern_ = stiffness_pattern(coupled, equation_, unknowns_);
  make_scatter();
}

void SolidModel::make_blocks(const std::vector<int>& elements) {
  for (int region = 0; region < static_cast<int>(solid_->laws.size()); ++region) {
    std::vector<int> members;
    for (const int e : elements)
      if (mesh().region[to_index(e)] == region) members.push_back(e);
    for (std::size_t first = 0; first < members.size(); first += kLanes) {
      blocks_.push_back(make_block(members, first, region));
    }
  }
}

SolidModel::Block SolidModel::make_block(const std::vector<int>& elements, std::size_t first,
                                         int region) const {
  Block block;
  block.region = region;
  block.count = static_cast<int>(std::min<std::size_t>(kLanes, elements.size() - first));
  for (int lane = 0; lane < kLanes; ++lane) {
    const int element = elements[std::min(first + to_index(lane), elements.size() - 1)];
    const ElementGeometry<double> one = geometry_of(mesh(), element);
    block.element[to_index(lane)] = element;
    for (std::size_t a = 0; a < kTetNodes; ++a) {
      const int node = mesh().tetrahedra[to_index(element)][a];
      block.node[a][to_index(lane)] = node;
      block.equation[a][to_index(lane)] = equation(node);
    }
    if (has_nodal_pressure(solid_->dilatation))
      block.pressure_point[to_index(lane)] = nodal_.points_of(mesh(), element);
    block.geometry.volume[lane] = one.volume;
    const auto fibres =
        solid_->fibres.empty()
            ? solid_->laws[to_index(region)].fibres_at(to_vec3(centroid(mesh(), element)))
            : solid_->fibres[to_index(element)];
    for (std::size_t family = 0; family < fibres.size(); ++family)
      for (std::size_t j = 0; j < 3; ++j)
        block.geometry.fibres[family][j][lane] = fibres[family][j];
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t j = 0; j < 3; ++j) block.geometry.gradient[c][j][lane] = one.gradient[c][j];
  }
  return block;
}

int SolidModel::unknown(const Tetrahedron10& node, std::size_t row) const {
  const int first = equation(node[row / 3]);
  return first < 0 ? -1 : first + static_cast<int>(row % 3);
}

void SolidModel::make_scatter() {
  scatter_.assign(blocks_.size() * kElementEntries * kLanes, -1);
  int* position = scatter_.data();
  for (const Block& block : blocks_)
    for (std::size_t row = 0; row < 3 * kTetNodes; ++row)
      for (std::size_t column = 0; column <= row; ++column, position += kLanes)
        for (int lane = 0; lane < block.count; ++lane) {
          const auto& node = mesh().tetrahedra[to_index(block.element[to_index(lane)])];
          const int i = unknown(node, row), j = unknown(node, column);
          if (i >= 0 && j >= 0) position[lane] = pattern_.position(i, j);
        }
}

}  // namespace palpate::fem
