// SPDX-License-Identifier: AGPL-3.0-or-later
// What a SolidModel says of a displacement: energy, forces, stiffness, and the state of its
// elements.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/laws/scaled_isochoric.hpp"
#include "fem/mesh/point_text.hpp"
#include "fem/solid/ellipticity.hpp"
#include "fem/solid/rigid_motion.hpp"
#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

ElementVector<Lanes> SolidModel::gather(const Block& block, const Displacement& u) const {
  ElementVector<Lanes> local;
  for (std::size_t a = 0; a < kTetNodes; ++a)
    for (int lane = 0; lane < kLanes; ++lane) {
      const int node = block.node[a][to_index(lane)];
      for (int i = 0; i < 3; ++i) local[a][to_index(i)][lane] = u(i, node);
    }
  return local;
}

void SolidModel::scatter(const Block& block, const ElementVector<Lanes>& forces,
                         Eigen::VectorXd& f) const {
  for (std::size_t a = 0; a < kTetNodes; ++a)
    for (int lane = 0; lane < block.count; ++lane) {
      const int first = block.equation[a][to_index(lane)];
      if (first < 0) continue;
      for (int i = 0; i < 3; ++i) f[first + i] += forces[a][to_index(i)][lane];
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

/// f of the law of a block: in a step of relaxation the scaled one, augmented where its elements
/// have multipliers.
template <class Block, class F>
auto with_law(const Solid& solid, const Block& block, const HistoryStress* step,
              const DilatationMultipliers* multipliers, F&& f) {
  const Law& law = solid.laws[to_index(block.region)];
  if (step != nullptr) return f(ScaledIsochoric{law, step->factor[to_index(block.region)]});
  if (multipliers == nullptr || !multipliers->relax(block.region) ||
      has_nodal_pressure(solid.dilatation))
    return f(law);
  return f(multipliers->augmented(law, block.region, block.element));
}

std::array<int, kLanes> all_lanes(int index) {
  std::array<int, kLanes> lanes;
  lanes.fill(index);
  return lanes;
}

/// The values of eight elements.
Lanes of_elements(const std::vector<double>& values, const std::array<int, kLanes>& element) {
  Lanes some;
  for (int lane = 0; lane < kLanes; ++lane) some[lane] = values[to_index(element[to_index(lane)])];
  return some;
}

double smallest(const ElementKinematics<Lanes>& k) {
  return std::min({k.J[0].minCoeff(), k.J[1].minCoeff(), k.J[2].minCoeff(), k.J[3].minCoeff()});
}

/// m^3, of the elements in use as they are displaced.
double volume_of(int count, const ElementGeometry<Lanes>& geometry,
                 const ElementKinematics<Lanes>& k) {
  const Lanes volume = geometry.volume * k.mean_J;
  return volume.head(count).sum();
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
std::vector<double> SolidModel::point_dilatations(const Kinematics& kinematics_of) const {
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
  for (std::size_t n = 0; n < points.size(); ++n) mean[n] /= points[n].volume;
  return mean;
}

template <class Kinematics>
SolidModel::PointState SolidModel::point_state(const Kinematics& kinematics_of,
                                               const DilatationMultipliers* multipliers) const {
  PointState state;
  const auto& points = nodal_.points();
  const std::vector<double> mean = point_dilatations(kinematics_of);
  for (std::size_t n = 0; n < points.size(); ++n) {
    const int region = points[n].region;
    const Lanes J = Lanes::Constant(mean[n]);
    const auto add = [&](const auto& law) {
      state.pressure.push_back(law.pressure(J)[0]);
      state.slope.push_back(law.pressure_slope(J)[0]);
      state.energy += points[n].volume * law.volumetric_energy(J)[0];
    };
    const Law& law = solid_->laws[to_index(region)];
    if (multipliers != nullptr && multipliers->relax(region))
      add(multipliers->augmented(law, region, all_lanes(points[n].place)));
    else
      add(law);
  }
  return state;
}

SolidModel::PointState SolidModel::point_state(const Displacement& u,
                                               const DilatationMultipliers* multipliers) const {
  return point_state([&](const Block& block) { return kinematics_of(block, u); }, multipliers);
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

double SolidModel::work_of_gravity(const Displacement& u) const {
  double work = 0;
  for (int node = 0; node < static_cast<int>(solid_->weight.cols()); ++node)
    if (equation(node) >= 0) work += solid_->weight.col(node).dot(u.col(node));
  return work;
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
    state.volume += volume_of(block.count, block.geometry, k);
    const Lanes energy =
        with_law(*solid_, block, step(), multipliers, [&](const auto& law) -> Lanes {
          return element_energy(law, solid_->dilatation, block.geometry, k);
        });
    state.energy += energy.head(block.count).sum() + energy_of_history(block, k);
  }
  state.energy += point_state(u, multipliers).energy + foundation_.energy(u) - work_of_gravity(u);
  return checked(state);
}

SolidModel::State SolidModel::forces(const Displacement& u, Eigen::VectorXd& f,
                                     const DilatationMultipliers* multipliers) const {
  State state;
  f.setZero(pattern_.n);
  const PointState points = point_state(u, multipliers);
  for (const Block& block : blocks_) {
    const auto k = kinematics_of(block, u);
    state.min_J = std::min(state.min_J, smallest(k));
    if (!(state.min_J > 0)) return state;
    state.volume += volume_of(block.count, block.geometry, k);
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
                                    const std::vector<double>& pressures_of_elements,
                                    std::vector<double>& values) const {
  values.assign(to_index(pattern_.nonzeros()), 0.0);
  ElementMatrix<Lanes> K;
  const int* position = scatter_.data();
  const PointState points = point_state(kinematics_of, multipliers);
  for (const Block& block : blocks_) {
    const auto k = kinematics_of(block);
    with_law(*solid_, block, step, multipliers, [&](const auto& law) {
      PointPressures<Lanes> p = pressures(law, block, k, points);
      if (!pressures_of_elements.empty()) p.fill(of_elements(pressures_of_elements, block.element));
      element_stiffness(law, solid_->dilatation, block.geometry, k, p, K);
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
                           const DilatationMultipliers* multipliers,
                           const std::vector<double>& pressures) const {
  assemble_stiffness([&](const Block& block) { return kinematics_of(block, u); }, step(),
                     multipliers, pressures, values);
}

std::vector<double> SolidModel::foretold_pressures(const Displacement& from, const Displacement& to,
                                                   const DilatationMultipliers* multipliers) const {
  if (solid_->dilatation != Dilatation::Mean) return {};
  std::vector<double> pressures(mesh().tetrahedra.size(), 0.0);
  for (const Block& block : blocks_) {
    const ElementVector<Lanes> start = gather(block, from), end = gather(block, to);
    const ElementKinematics<Lanes> k = kinematics_of(block, start);
    const ElementVector<Lanes> slope =  // of the volume
        nodal_forces(block.geometry, [&](std::size_t q) { return k.cof[q]; });
    Lanes change = Lanes::Zero();
    for (std::size_t a = 0; a < kTetNodes; ++a)
      for (std::size_t i = 0; i < 3; ++i) change += slope[a][i] * (end[a][i] - start[a][i]);
    change /= block.geometry.volume;
    const Lanes p = with_law(*solid_, block, step(), multipliers, [&](const auto& law) -> Lanes {
      return law.pressure(k.mean_J) + law.pressure_slope(k.mean_J) * change;
    });
    for (int lane = 0; lane < block.count; ++lane)
      pressures[to_index(block.element[to_index(lane)])] = p[lane];
  }
  return pressures;
}

void SolidModel::turned_stiffness(const Displacement& u, std::vector<double>& values) const {
  const DilatationMultipliers none = multipliers();
  assemble_stiffness([&](const Block& block) { return turned(block, u); }, nullptr,
                     none.any() ? &none : nullptr, {}, values);
}

DilatationMultipliers SolidModel::multipliers() const {
  if (solid_->dilatation == Dilatation::Mean) return {solid_->laws, mesh().tetrahedra.size()};
  if (solid_->dilatation == Dilatation::Nodal) return {solid_->laws, nodal_.places()};
  return {};
}

template <class Pressure>
void SolidModel::set(const Displacement& u, DilatationMultipliers& multipliers,
                     Pressure&& pressure) const {
  if (has_nodal_pressure(solid_->dilatation)) {
    const std::vector<double> J =
        point_dilatations([&](const Block& block) { return kinematics_of(block, u); });
    for (std::size_t n = 0; n < J.size(); ++n) {
      const NodalPressure::Point& point = nodal_.points()[n];
      if (multipliers.relax(point.region))
        multipliers.values[to_index(point.place)] =
            pressure(point.region, all_lanes(point.place), Lanes::Constant(J[n]))[0];
    }
    return;
  }
  for (const Block& block : blocks_) {
    if (!multipliers.relax(block.region)) continue;
    const Lanes p = pressure(block.region, block.element, kinematics_of(block, u).mean_J);
    for (int lane = 0; lane < block.count; ++lane)
      multipliers.values[to_index(block.element[to_index(lane)])] = p[lane];
  }
}

void SolidModel::update(const Displacement& u, DilatationMultipliers& multipliers) const {
  set(u, multipliers, [&](int region, const std::array<int, kLanes>& pressure, const Lanes& J) {
    return multipliers.augmented(solid_->laws[to_index(region)], region, pressure).pressure(J);
  });
}

void SolidModel::take_pressures(const Displacement& u, DilatationMultipliers& multipliers) const {
  set(u, multipliers, [&](int region, const std::array<int, kLanes>&, const Lanes& J) {
    return solid_->laws[to_index(region)].pressure(J);
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
  worst.X = centroid(mesh(), element);
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
  return EllipticityLoss{weakest, centroid(mesh(), element)};
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
