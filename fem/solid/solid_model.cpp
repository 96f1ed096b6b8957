// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/solid_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fem/laws/scaled_isochoric.hpp"
#include "fem/mesh/point_text.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/solid/ellipticity.hpp"
#include "fem/solid/rigid_motion.hpp"

namespace palpate::fem {

namespace {

constexpr std::size_t kElementEntries = std::tuple_size_v<ElementMatrix<double>>;

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

Vec3 centroid(const QuadraticMesh& mesh, int element) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t c = 0; c < 4; ++c) sum += mesh.X.col(mesh.tetrahedra[to_index(element)][c]);
  return {sum[0] / 4, sum[1] / 4, sum[2] / 4};
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
                                             {},
                                             std::move(fibres)});
  solid->weight = nodal_weight(solid->mesh, gravity);
  return solid;
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

SolidModel SolidModel::without_stiffness(const SolidModel& whole, QuadraticMesh mesh) {
  SolidModel model(std::make_shared<const Solid>(
      Solid{std::move(mesh), whole.solid_->laws, whole.solid_->dilatation, {}, {}}));
  std::vector<bool> free = model.mesh().fixed;
  free.flip();
  model.number_unknowns(free);
  std::vector<int> elements(model.mesh().tetrahedra.size());
  std::iota(elements.begin(), elements.end(), 0);
  model.make_blocks(elements);
  model.pattern_.n = model.unknowns_;
  return model;
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
    if (has_nodal_pressure(solid_->dilatation))
      block.pressure_point[to_index(lane)] = nodal_.points_of(mesh(), element);
    block.geometry.volume[lane] = one.volume;
    const auto fibres = solid_->fibres.empty()
                            ? solid_->laws[to_index(region)].fibres_at(centroid(mesh(), element))
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

ElementVector<Lanes> SolidModel::gather(const Block& block, const Displacement& u) const {
  ElementVector<Lanes> local;
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto& node = mesh().tetrahedra[to_index(block.element[to_index(lane)])];
    for (std::size_t a = 0; a < kTetNodes; ++a)
      for (int i = 0; i < 3; ++i) local[a][to_index(i)][lane] = u(i, node[a]);
  }
  return local;
}

void SolidModel::scatter(const Block& block, const ElementVector<Lanes>& forces,
                         Eigen::VectorXd& f) const {
  for (int lane = 0; lane < block.count; ++lane) {
    const auto& node = mesh().tetrahedra[to_index(block.element[to_index(lane)])];
    for (std::size_t a = 0; a < kTetNodes; ++a) {
      const int first = equation(node[a]);
      if (first < 0) continue;
      for (int i = 0; i < 3; ++i) f[first + i] += forces[a][to_index(i)][lane];
    }
  }
}

ElementKinematics<Lanes> SolidModel::kinematics_of(const Block& block,
                                                   const ElementVector<Lanes>& u) const {
  return is_linear(solid_->dilatation) ? linear_kinematics(block.geometry, u)
                                       : kinematics(block.geometry, u);
}

ElementKinematics<Lanes> SolidModel::turned(const Block& block, const Displacement& u) const {
  const ElementKinematics<Lanes> present = kinematics_of(block, u);
  ElementVector<Lanes> local;
  for (int lane = 0; lane < kLanes; ++lane) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Tensor2<Lanes>& F : present.F)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum(i, j) += F[to_index(3 * i + j)][lane];
    const Eigen::Matrix3d turn = nearest_rotation(sum) - Eigen::Matrix3d::Identity();
    const auto& node = mesh().tetrahedra[to_index(block.element[to_index(lane)])];
    std::array<Eigen::Vector3d, kTetNodes> step;
    for (std::size_t c = 0; c < 4; ++c) step[c] = turn * mesh().X.col(node[c]);
    // The element is straight, also where the surface is curved.
    for (std::size_t e = 0; e < kTetEdges.size(); ++e)
      step[4 + e] = 0.5 * (step[kTetEdges[e][0]] + step[kTetEdges[e][1]]);
    for (std::size_t a = 0; a < kTetNodes; ++a)
      for (int i = 0; i < 3; ++i) local[a][to_index(i)][lane] = step[a][i];
  }
  return kinematics_of(block, local);
}

namespace {

/// f of the law of a block: in a step of relaxation the scaled one, augmented where its region has
/// multipliers.
template <class Block, class F>
auto with_law(const Solid& solid, const Block& block, const HistoryStress* step,
              const DilatationMultipliers* multipliers, F&& f) {
  const Law& law = solid.laws[to_index(block.region)];
  if (step != nullptr) return f(ScaledIsochoric{law, step->factor[to_index(block.region)]});
  if (multipliers == nullptr || !multipliers->relax(block.region)) return f(law);
  return f(multipliers->augmented(law, block.region, block.element));
}

double smallest(const ElementKinematics<Lanes>& k) {
  return std::min({k.J[0].minCoeff(), k.J[1].minCoeff(), k.J[2].minCoeff(), k.J[3].minCoeff()});
}

/// Exponential laws overflow long before an element inverts: such a state is inadmissible, too.
SolidModel::State checked(SolidModel::State state) {
  if (!std::isfinite(state.energy)) state.min_J = 0;
  return state;
}

/// Mean over the element of tr(sigma)/3 = p + P:F/(3 J).
Lanes mean_stress(const Law& law, const PointPressures<Lanes>& pressure,
                  const ElementGeometry<Lanes>& geometry, const ElementKinematics<Lanes>& k) {
  Lanes mean = Lanes::Zero();
  for (std::size_t q = 0; q < kTetPoints; ++q) {
    const Tensor2<Lanes> P = law.piola(k.F[q], k.cof[q], k.J[q], geometry.fibres);
    mean += 0.25 * (pressure[q] + double_contraction(P, k.F[q]) / (3.0 * k.J[q]));
  }
  return mean;
}

}  // namespace

template <class Kinematics>
SolidModel::PointState SolidModel::point_state(const Kinematics& kinematics_of) const {
  PointState state;
  const auto& points = nodal_.points();
  std::vector<double> mean(points.size(), 0.0);
  for (const Block& block : blocks_) {
    if (points.empty()) break;
    const auto k = kinematics_of(block);
    const auto& J = k.J;
    const Lanes all = kTetFar * (J[0] + J[1] + J[2] + J[3]);
    for (std::size_t c = 0; c < 4; ++c) {
      const Lanes part = 0.25 * block.geometry.volume * (all + (kTetNear - kTetFar) * J[c]);
      for (int lane = 0; lane < block.count; ++lane)
        if (const int point = block.pressure_point[to_index(lane)][c]; point >= 0)
          mean[to_index(point)] += part[lane];
    }
  }
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Law& law = solid_->laws[to_index(points[n].region)];
    const Lanes J = Lanes::Constant(mean[n] / points[n].volume);
    state.pressure.push_back(law.pressure(J)[0]);
    state.slope.push_back(law.pressure_slope(J)[0]);
    state.energy += points[n].volume * law.volumetric_energy(J)[0];
  }
  return state;
}

SolidModel::PointState SolidModel::point_state(const Displacement& u) const {
  return point_state([&](const Block& block) { return kinematics_of(block, u); });
}

template <class L>
PointPressures<Lanes> SolidModel::pressures(const L& law, const Block& block,
                                            const ElementKinematics<Lanes>& k,
                                            const PointState& points) const {
  if (!has_nodal_pressure(solid_->dilatation)) return own_pressures(law, solid_->dilatation, k);
  std::array<Lanes, 4> corner;
  for (std::size_t c = 0; c < 4; ++c)
    for (int lane = 0; lane < kLanes; ++lane) {
      const int point = block.pressure_point[to_index(lane)][c];
      corner[c][lane] = point >= 0 ? points.pressure[to_index(point)] : 0.0;
    }
  return is_linear(solid_->dilatation) ? mean_pressure(corner) : interpolated_pressures(corner);
}

/// (U''/V_n) g g^T with g = d(V_n Jbar_n)/du.
template <class Kinematics>
void SolidModel::add_point_stiffness(const Kinematics& kinematics_of, const PointState& state,
                                     std::vector<double>& values) const {
  const auto& points = nodal_.points();
  std::vector<Eigen::Matrix3Xd> slope;
  for (const auto& point : points)
    slope.emplace_back(Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(point.nodes.size())));
  for (const Block& block : blocks_) {
    if (points.empty()) break;
    const auto k = kinematics_of(block);
    for (std::size_t c = 0; c < 4; ++c) {
      const auto g = dilatation_forces(solid_->dilatation, block.geometry, k, c);
      for (int lane = 0; lane < block.count; ++lane) {
        const int point = block.pressure_point[to_index(lane)][c];
        if (point < 0) continue;
        const auto& nodes = points[to_index(point)].nodes;
        const auto& node = mesh().tetrahedra[to_index(block.element[to_index(lane)])];
        for (std::size_t a = 0; a < kTetNodes; ++a) {
          if (equation(node[a]) < 0) continue;
          const auto position =
              std::lower_bound(nodes.begin(), nodes.end(), node[a]) - nodes.begin();
          for (int i = 0; i < 3; ++i)
            slope[to_index(point)](i, position) += g[a][to_index(i)][lane];
        }
      }
    }
  }
  for (std::size_t n = 0; n < points.size(); ++n)
    add_rank_one(pattern_, equation_, points[n].nodes, state.slope[n] / points[n].volume,
                 slope[n].data(), values);
}

Eigen::VectorXd SolidModel::weight() const {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(unknowns_);
  if (solid_->weight.cols() == 0) return load;
  for (int node = 0; node < mesh().nodes(); ++node)
    if (equation(node) >= 0) load.segment<3>(equation(node)) = solid_->weight.col(node);
  return load;
}

double SolidModel::work_of_gravity(const Displacement& u) const {
  double work = 0;
  for (int node = 0; node < static_cast<int>(solid_->weight.cols()); ++node)
    if (equation(node) >= 0) work += solid_->weight.col(node).dot(u.col(node));
  return work;
}

SolidModel SolidModel::relaxing(const SolidModel& body, const HistoryStress* step) {
  SolidModel model = body;
  model.step_ = step;
  return model;
}

double SolidModel::energy_of_history(const Block& block, const ElementKinematics<Lanes>& k) const {
  if (step() == nullptr) return 0;
  const Lanes energy = history_energy(solid_->dilatation, block.geometry, k,
                                      fem::gather(step()->stress, block.element));
  return energy.head(block.count).sum();
}

StressField SolidModel::isochoric_stress(const Displacement& u) const {
  StressField field(mesh().tetrahedra.size());
  for (const Block& block : blocks_) {
    const auto S = isochoric_stresses(solid_->laws[to_index(block.region)], block.geometry,
                                      kinematics_of(block, u));
    for (int lane = 0; lane < block.count; ++lane)
      for (std::size_t q = 0; q < kTetPoints; ++q)
        for (std::size_t entry = 0; entry < kStressEntries.size(); ++entry)
          field[to_index(block.element[to_index(lane)])][q][entry] =
              S[q][kStressEntries[entry]][lane];
  }
  return field;
}

double SolidModel::volume(const Displacement& u) const {
  double sum = 0;
  for (const Block& block : blocks_) {
    const Lanes volume = block.geometry.volume * kinematics_of(block, u).mean_J;
    sum += volume.head(block.count).sum();
  }
  return sum;
}

std::vector<double> SolidModel::isochoric_energies(const Displacement& u) const {
  std::vector<double> energies(solid_->laws.size(), 0.0);
  for (const Block& block : blocks_) {
    const auto k = kinematics_of(block, u);
    const Law& law = solid_->laws[to_index(block.region)];
    Lanes density = Lanes::Zero();
    const std::size_t points = points_of(solid_->dilatation);
    for (std::size_t q = 0; q < points; ++q)
      density += law.psi(k.F[q], k.J[q], block.geometry.fibres) / static_cast<double>(points);
    const Lanes energy = block.geometry.volume * density;
    energies[to_index(block.region)] += energy.head(block.count).sum();
  }
  return energies;
}

SolidModel::State SolidModel::energy(const Displacement& u,
                                     const DilatationMultipliers* multipliers) const {
  State state;
  for (const Block& block : blocks_) {
    const auto k = kinematics_of(block, u);
    state.min_J = std::min(state.min_J, smallest(k));
    if (!(state.min_J > 0)) return state;
    const Lanes energy =
        with_law(*solid_, block, step(), multipliers, [&](const auto& law) -> Lanes {
          return element_energy(law, solid_->dilatation, block.geometry, k);
        });
    state.energy += energy.head(block.count).sum() + energy_of_history(block, k);
  }
  state.energy += point_state(u).energy + foundation_.energy(u) - work_of_gravity(u);
  return checked(state);
}

SolidModel::State SolidModel::forces(const Displacement& u, Eigen::VectorXd& f,
                                     const DilatationMultipliers* multipliers) const {
  State state;
  f.setZero(pattern_.n);
  const PointState points = point_state(u);
  for (const Block& block : blocks_) {
    const auto k = kinematics_of(block, u);
    state.min_J = std::min(state.min_J, smallest(k));
    if (!(state.min_J > 0)) return state;
    with_law(*solid_, block, step(), multipliers, [&](const auto& law) {
      const Lanes energy = element_energy(law, solid_->dilatation, block.geometry, k);
      state.energy += energy.head(block.count).sum() + energy_of_history(block, k);
      scatter(block,
              element_forces(law, solid_->dilatation, block.geometry, k,
                             pressures(law, block, k, points)),
              f);
    });
    if (step() != nullptr)
      scatter(block,
              history_forces(solid_->dilatation, block.geometry, k,
                             fem::gather(step()->stress, block.element)),
              f);
  }
  state.energy += points.energy + foundation_.energy(u) - work_of_gravity(u);
  foundation_.add_forces(equation_, u, f);
  for (int node = 0; node < static_cast<int>(solid_->weight.cols()); ++node)
    if (equation(node) >= 0) f.segment<3>(equation(node)) -= solid_->weight.col(node);
  return checked(state);
}

template <class Kinematics>
void SolidModel::assemble_stiffness(const Kinematics& kinematics_of, const HistoryStress* step,
                                    const DilatationMultipliers* multipliers,
                                    std::vector<double>& values) const {
  values.assign(to_index(pattern_.nonzeros()), 0.0);
  ElementMatrix<Lanes> K;
  const int* position = scatter_.data();
  const PointState points = point_state(kinematics_of);
  for (const Block& block : blocks_) {
    const auto k = kinematics_of(block);
    with_law(*solid_, block, step, multipliers, [&](const auto& law) {
      element_stiffness(law, solid_->dilatation, block.geometry, k,
                        pressures(law, block, k, points), K);
    });
    if (step != nullptr)
      add_history_stiffness(solid_->dilatation, block.geometry,
                            fem::gather(step->stress, block.element), K);
    for (std::size_t entry = 0; entry < kElementEntries; ++entry, position += kLanes)
      for (int lane = 0; lane < block.count; ++lane)
        if (position[lane] >= 0) values[to_index(position[lane])] += K[entry][lane];
  }
  add_point_stiffness(kinematics_of, points, values);
  foundation_.add_stiffness(equation_, pattern_, values);
}

void SolidModel::stiffness(const Displacement& u, std::vector<double>& values,
                           const DilatationMultipliers* multipliers) const {
  assemble_stiffness([&](const Block& block) { return kinematics_of(block, u); }, step(),
                     multipliers, values);
}

void SolidModel::turned_stiffness(const Displacement& u, std::vector<double>& values) const {
  const DilatationMultipliers none = multipliers();
  assemble_stiffness([&](const Block& block) { return turned(block, u); }, nullptr,
                     none.any() ? &none : nullptr, values);
}

DilatationMultipliers SolidModel::multipliers() const {
  if (solid_->dilatation != Dilatation::Mean) return {};
  return {solid_->laws, mesh().tetrahedra.size()};
}

template <class Pressure>
void SolidModel::set(const Displacement& u, DilatationMultipliers& multipliers,
                     Pressure&& pressure) const {
  for (const Block& block : blocks_) {
    if (!multipliers.relax(block.region)) continue;
    const Lanes p = pressure(block, kinematics_of(block, u).mean_J);
    for (int lane = 0; lane < block.count; ++lane)
      multipliers.values[to_index(block.element[to_index(lane)])] = p[lane];
  }
}

void SolidModel::update(const Displacement& u, DilatationMultipliers& multipliers) const {
  set(u, multipliers, [&](const Block& block, const Lanes& J) {
    const Law& law = solid_->laws[to_index(block.region)];
    return multipliers.augmented(law, block.region, block.element).pressure(J);
  });
}

void SolidModel::take_pressures(const Displacement& u, DilatationMultipliers& multipliers) const {
  set(u, multipliers, [&](const Block& block, const Lanes& J) {
    return solid_->laws[to_index(block.region)].pressure(J);
  });
}

SolidModel::Compressed SolidModel::most_compressed(const Displacement& u) const {
  Compressed worst{1, Eigen::Vector3d::Zero()};
  int element = -1;
  for (const Block& block : blocks_) {
    const auto k = kinematics_of(block, u);
    const Lanes J = k.J[0].min(k.J[1]).min(k.J[2]).min(k.J[3]);
    for (int lane = 0; lane < block.count; ++lane)
      if (element < 0 || J[lane] < worst.J) {
        worst.J = J[lane];
        element = block.element[to_index(lane)];
      }
  }
  if (element < 0) return worst;
  for (std::size_t c = 0; c < 4; ++c)
    worst.X += 0.25 * mesh().X.col(mesh().tetrahedra[to_index(element)][c]);
  return worst;
}

Lanes SolidModel::min_acoustic_eigenvalues(const Block& block,
                                           const ElementKinematics<Lanes>& k) const {
  const Law& law = solid_->laws[to_index(block.region)];
  const bool own = solid_->dilatation == Dilatation::Pointwise;
  Lanes weakest = Lanes::Constant(std::numeric_limits<double>::infinity());
  for (std::size_t q = 0; q < points_of(solid_->dilatation); ++q) {
    Tensor4<Lanes> A;
    for (auto& row : A) row.fill(Lanes::Zero());
    law.add_tangent(k.F[q], k.cof[q], k.J[q], block.geometry.fibres, A);
    add_dilatation_tangent(k.cof[q], law.pressure_slope(own ? k.J[q] : k.mean_J), A);
    weakest = weakest.min(min_acoustic_eigenvalue(k.F[q], A));
  }
  return weakest;
}

std::string SolidModel::EllipticityLoss::reason() const {
  return "strong ellipticity is lost in the element at " + point_text(X) +
         ": further results would depend on the mesh";
}

std::optional<SolidModel::EllipticityLoss> SolidModel::ellipticity_loss(
    const Displacement& u) const {
  double weakest = std::numeric_limits<double>::min();
  int element = -1;
  for (const Block& block : blocks_) {
    if (solid_->laws[to_index(block.region)].polyconvex()) continue;
    const Lanes stiffness = min_acoustic_eigenvalues(block, kinematics_of(block, u));
    for (int lane = 0; lane < block.count; ++lane) {
      if (stiffness[lane] >= weakest) continue;
      weakest = stiffness[lane];
      element = block.element[to_index(lane)];
    }
  }
  if (element < 0) return std::nullopt;
  const Vec3 X = centroid(mesh(), element);
  return EllipticityLoss{weakest, to_eigen(X)};
}

void SolidModel::element_fields(const Displacement& u, std::vector<double>& energy_density,
                                std::vector<double>& pressure) const {
  energy_density.resize(mesh().tetrahedra.size());
  pressure.resize(mesh().tetrahedra.size());
  const PointState points = point_state(u);
  for (const Block& block : blocks_) {
    const Law& law = solid_->laws[to_index(block.region)];
    const auto k = kinematics_of(block, u);
    const Lanes energy = element_energy(law, solid_->dilatation, block.geometry, k);
    const Lanes density = energy / block.geometry.volume;
    const Lanes p = mean_stress(law, pressures(law, block, k, points), block.geometry, k);
    for (int lane = 0; lane < block.count; ++lane) {
      energy_density[to_index(block.element[to_index(lane)])] = density[lane];
      pressure[to_index(block.element[to_index(lane)])] = p[lane];
    }
  }
}

void add_step(const SolidModel& model, double length, const Eigen::VectorXd& d, Displacement& u) {
  for (int node = 0; node < model.mesh().nodes(); ++node)
    if (model.equation(node) >= 0) u.col(node) += length * d.segment<3>(model.equation(node));
  straighten(model.mesh(), u);
}

}  // namespace palpate::fem
