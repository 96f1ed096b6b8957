// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/factor/sparse_pattern.hpp"
#include "fem/laws/law.hpp"
#include "fem/laws/material.hpp"
#include "fem/mesh/quadratic_mesh.hpp"
#include "fem/mesh/refined_mesh.hpp"
#include "fem/solid/dilatation_multipliers.hpp"
#include "fem/solid/element.hpp"
#include "fem/solid/foundation.hpp"
#include "fem/solid/gravity.hpp"
#include "fem/solid/history_stress.hpp"
#include "fem/solid/nodal_pressure.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

/// Displacement of every node, (3, nodes), m; zero at fixed nodes.
using Displacement = Eigen::Matrix3Xd;

/// A mesh and the law of each region, shared by the models of the body.
struct Solid {
  QuadraticMesh mesh;
  std::vector<Law> laws;
  Dilatation dilatation;
  Gravity gravity;
  Eigen::Matrix3Xd weight;  ///< (nodes), N; no columns where there is none
  /// Fibre directions of each element; empty: those of the laws at the centroids.
  std::vector<std::array<Vec3, 2>> fibres;
};

/// One flag for each node: whether it lies within `radius` of `centre` at rest.
std::vector<bool> nodes_within(const QuadraticMesh& mesh, const Eigen::Vector3d& centre,
                               double radius);

/// The body, or a part of it, with its elastic foundation and without the tool: energy, internal
/// forces and stiffness as functions of the displacement, on a chosen set of free nodes. Immutable
/// after construction; every method may be called from several threads.
class SolidModel {
 public:
  /// The whole body. One law for each region, in the order of Body::region_names. `fibres`: see
  /// Solid.
  SolidModel(const Body& body, std::vector<Law> laws, Dilatation dilatation = Dilatation::Mean,
             const Gravity& gravity = {}, std::vector<std::array<Vec3, 2>> fibres = {});

  /// The part of `whole` around `centre`: the nodes within `radius` are free, the model has their
  /// elements, and all other nodes have prescribed displacements.
  SolidModel(const SolidModel& whole, const Eigen::Vector3d& centre, double radius);
  /// The same with any choice of free nodes; nodes fixed in `whole` stay fixed.
  SolidModel(const SolidModel& whole, std::vector<bool> free);

  /// `whole` on a refined mesh of the body, for energies and forces only: it has no stiffness, and
  /// its pattern() has only the number of unknowns. Not with linear displacements.
  static SolidModel without_stiffness(const SolidModel& whole, const RefinedMesh& refined);

  /// The same body in a step of its relaxation: with the energy of HistoryStress in place of the
  /// isochoric one. `step` must outlive the model, and may change between calls; while it has no
  /// factors, the model is that of `body`.
  static SolidModel relaxing(const SolidModel& body, const HistoryStress* step);

  struct State {
    double energy = 0;  ///< J, strain energy and energy of the foundation less work of gravity
    double volume = 0;  ///< m^3, of the elements as they are displaced
    /// Smallest det F at the Gauss points; 0 where the energy has no finite value. The rest is
    /// void when it is not positive.
    double min_J = 1;
  };

  /// With `multipliers`, here and below: that of the augmented laws.
  State energy(const Displacement& u, const DilatationMultipliers* multipliers = nullptr) const;
  /// Internal forces on the unknowns, N, with those of the foundation, less the weight.
  State forces(const Displacement& u, Eigen::VectorXd& f,
               const DilatationMultipliers* multipliers = nullptr) const;
  /// Values of pattern(), N/m. `pressures`: of the elements, Pa, for the geometric part, in place
  /// of those at `u`; empty: those at `u`.
  void stiffness(const Displacement& u, std::vector<double>& values,
                 const DilatationMultipliers* multipliers = nullptr,
                 const std::vector<double>& pressures = {}) const;
  /// The pressures of the elements at `to`, Pa, as those at `from` foretell them,
  ///   p + d2U/dJ2 (dJbar/du) (to - from),
  /// which are those of a Newton step with the pressures as unknowns. In the pressures at `to` the
  /// bulk modulus multiplies what is quadratic in the step: after a long one they are far from
  /// those of the equilibrium. Empty unless the pressures are those of the elements.
  std::vector<double> foretold_pressures(const Displacement& from, const Displacement& to,
                                         const DilatationMultipliers* multipliers = nullptr) const;

  /// Values of pattern(), N/m: the stiffness at rest of every element, turned with the element,
  ///   sum_e R_e K_e R_e^T,
  /// R_e the rotation nearest to its mean deformation gradient [Rankin & Brogan 1986]. It knows how
  /// a thin part has bent, and is positive definite wherever the one at rest is, with elements that
  /// are inverted as well. Springs are those at rest.
  void turned_stiffness(const Displacement& u, std::vector<double>& values) const;

  /// Multipliers of 0; none for the displacement element, which has no pressures, and for linear
  /// elements, whose pressures alternate: the multipliers would leave twice the wanted error of the
  /// force.
  DilatationMultipliers multipliers() const;
  /// The step of the method of multipliers at `u`.
  void update(const Displacement& u, DilatationMultipliers& multipliers) const;
  /// Sets the multipliers to dU/dJ at `u`, which they are in every equilibrium.
  void take_pressures(const Displacement& u, DilatationMultipliers& multipliers) const;

  /// 2 dPsi_iso/dC of the laws at the Gauss points, Pa.
  StressField isochoric_stress(const Displacement& u) const;
  /// The isochoric strain energy of each region, J. What remains of energy() does not relax.
  std::vector<double> isochoric_energies(const Displacement& u) const;

  /// Element means: strain energy density, J/m^3, and the mean of the Cauchy stress, Pa (tension
  /// positive), which for a law with a volumetric part is its dU/dJ.
  void element_fields(const Displacement& u, std::vector<double>& energy_density,
                      std::vector<double>& pressure) const;

  /// The weight on the unknowns, N; 0 without gravity.
  Eigen::VectorXd weight() const;
  /// The norm of the weight on all nodes of the body, N.
  double weight_norm() const { return solid_->weight.norm(); }

  /// The element with the smallest det F at a Gauss point: that value, and its centre at rest, m.
  struct Compressed {
    double J;
    Eigen::Vector3d X;
  };
  Compressed most_compressed(const Displacement& u) const;

  /// The Gauss point with the smallest eigenvalue of the acoustic tensor, where it is not positive:
  /// strong ellipticity is lost. `X` is the centre of its element at rest, m; the stiffness is that
  /// eigenvalue, Pa.
  struct EllipticityLoss {
    double stiffness;
    Eigen::Vector3d X;
    std::string reason() const;  ///< why a path ends there
  };
  /// Nothing where every Gauss point is elliptic; polyconvex laws are not checked.
  std::optional<EllipticityLoss> ellipticity_loss(const Displacement& u) const;

  const QuadraticMesh& mesh() const { return solid_->mesh; }
  /// First of the three unknowns of a node, -1 where it is not free.
  int equation(int node) const { return equation_[to_index(node)]; }
  const SparsePattern& pattern() const { return pattern_; }
  double bytes() const;  ///< of its own tables, without the shared mesh

 private:
  struct Block {
    int count = 0;  ///< SIMD lanes in use; the others repeat the last element
    int region = 0;
    std::array<int, kLanes> element{};
    std::array<std::array<int, kLanes>, kTetNodes> node{};
    std::array<std::array<int, kLanes>, kTetNodes> equation{};  ///< of the nodes; -1: fixed
    std::array<std::array<int, 4>, kLanes> pressure_point{};    ///< with nodal pressures; else -1
    ElementGeometry<Lanes> geometry;
  };
  /// Nodal pressures: derivatives of U at Jbar_n, and its energy.
  struct PointState {
    std::vector<double> pressure, slope;  ///< dU/dJ and d2U/dJ2, Pa
    double energy = 0;                    ///< sum of V_n U(Jbar_n), J
  };

  explicit SolidModel(std::shared_ptr<const Solid> solid) : solid_(std::move(solid)) {}
  void number_unknowns(const std::vector<bool>& free);
  void take_elements(const std::vector<int>& elements);
  void make_blocks(const std::vector<int>& elements);
  Block make_block(const std::vector<int>& elements, std::size_t first, int region) const;
  /// The unknown of a row of an element, -1 where it is not free.
  int unknown(const Tetrahedron10& node, std::size_t row) const;
  static constexpr std::size_t kElementEntries = std::tuple_size_v<ElementMatrix<double>>;
  void make_scatter();
  ElementVector<Lanes> gather(const Block& block, const Displacement& u) const;
  ElementKinematics<Lanes> kinematics_of(const Block& block, const ElementVector<Lanes>& u) const;
  ElementKinematics<Lanes> kinematics_of(const Block& block, const Displacement& u) const {
    return kinematics_of(block, gather(block, u));
  }
  /// The elements turned as at `u`, without strain.
  ElementKinematics<Lanes> turned(const Block& block, const Displacement& u) const;
  void scatter(const Block& block, const ElementVector<Lanes>& forces, Eigen::VectorXd& f) const;
  double work_of_gravity(const Displacement& u) const;  ///< on the free nodes, J
  /// `kinematics_of`: of a block.
  template <class Kinematics>
  std::vector<double> point_dilatations(const Kinematics& kinematics_of) const;  ///< Jbar_n
  template <class Kinematics>
  PointState point_state(const Kinematics& kinematics_of,
                         const DilatationMultipliers* multipliers) const;
  PointState point_state(const Displacement& u,
                         const DilatationMultipliers* multipliers = nullptr) const;
  /// The smallest eigenvalue of the acoustic tensor at the points of each element of a block, Pa;
  /// where it is positive, a positive lower value.
  Lanes min_acoustic_eigenvalues(const Block& block, const ElementKinematics<Lanes>& k) const;
  template <class L>
  PointPressures<Lanes> pressures(const L& law, const Block& block,
                                  const ElementKinematics<Lanes>& k,
                                  const PointState& points) const;
  /// Sets the multipliers to pressure(region, which of them, mean J).
  template <class Pressure>
  void set(const Displacement& u, DilatationMultipliers& multipliers, Pressure&& pressure) const;
  template <class Kinematics>
  void add_point_stiffness(const Kinematics& kinematics_of, const PointState& points,
                           std::vector<double>& values) const;
  template <class Kinematics>
  void assemble_stiffness(const Kinematics& kinematics_of, const HistoryStress* step,
                          const DilatationMultipliers* multipliers,
                          const std::vector<double>& pressures, std::vector<double>& values) const;

  /// The step of its relaxation that the model is in; null where it is elastic.
  const HistoryStress* step() const {
    return step_ != nullptr && !step_->factor.empty() ? step_ : nullptr;
  }
  /// Integral of H:(C - 1)/2 over the elements of a block, J; 0 where there is no step.
  double energy_of_history(const Block& block, const ElementKinematics<Lanes>& k) const;

  std::shared_ptr<const Solid> solid_;
  const HistoryStress* step_ = nullptr;
  std::vector<int> equation_;  ///< (nodes)
  int unknowns_ = 0;
  SparsePattern pattern_;
  NodalPressure nodal_;
  Foundation foundation_;
  std::vector<Block> blocks_;
  std::vector<int> scatter_;  ///< index into the values, by block, entry and SIMD lane; -1: none
};

/// u += length d on the unknowns of the model.
void add_step(const SolidModel& model, double length, const Eigen::VectorXd& d, Displacement& u);

}  // namespace palpate::fem
