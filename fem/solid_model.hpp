// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/element.hpp"
#include "fem/material.hpp"
#include "fem/quadratic_mesh.hpp"
#include "fem/sparse_pattern.hpp"

namespace palpate::fem {

/// Displacement of every node, (3, nodes), m; zero at held nodes.
using Displacement = Eigen::Matrix3Xd;

/// The body without the tool: strain energy, internal forces and stiffness as functions of the
/// displacement. Immutable after construction; every method may be called from several threads.
class SolidModel {
 public:
  /// One law for each region of the body, in the order of Body::region_names.
  SolidModel(const Body& body, std::vector<NeoHookean> laws);

  struct State {
    double energy = 0;  ///< J
    double min_J = 1;   ///< smallest det F at the Gauss points; the rest is void when <= 0
  };

  State energy(const Displacement& u) const;
  /// Internal forces on the unknowns, N.
  State forces(const Displacement& u, Eigen::VectorXd& f) const;
  /// Values of pattern(), N/m.
  void stiffness(const Displacement& u, std::vector<double>& values) const;

  /// Element means: strain energy density, J/m^3, and pressure dU/dJ, Pa (tension positive).
  void element_fields(const Displacement& u, std::vector<double>& energy_density,
                      std::vector<double>& pressure) const;

  const QuadraticMesh& mesh() const { return mesh_; }
  const SparsePattern& pattern() const { return pattern_; }

 private:
  struct Block {
    int count = 0;  ///< lanes in use; the others repeat the last element
    int region = 0;
    std::array<int, kLanes> element{};
    ElementGeometry<Lanes> geometry;
  };

  void make_blocks();
  Block make_block(const std::vector<int>& elements, std::size_t first) const;
  void make_scatter();
  ElementVector<Lanes> gather(const Block& block, const Displacement& u) const;
  void scatter(const Block& block, const ElementVector<Lanes>& forces, Eigen::VectorXd& f) const;

  QuadraticMesh mesh_;
  std::vector<NeoHookean> laws_;
  SparsePattern pattern_;
  std::vector<Block> blocks_;
  std::vector<int> scatter_;  ///< place in the values of each entry of each element, -1 if held
};

}  // namespace palpate::fem
