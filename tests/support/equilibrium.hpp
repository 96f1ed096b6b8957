// SPDX-License-Identifier: AGPL-3.0-or-later
// Equilibrium of a body under dead loads, by Newton's method, for tests without a tool.
#pragma once

#include <functional>
#include <vector>

#include "fem/solid/solid_model.hpp"

namespace palpate::test {

/// Dead nodal loads, (3, nodes), N.
using Loads = Eigen::Matrix3Xd;

/// Nodal loads of a constant traction on the boundary facets chosen by their nodes.
Loads traction_loads(const fem::QuadraticMesh& mesh, const Eigen::Vector3d& traction,
                     const std::function<bool(const Eigen::Vector3d& X)>& on_surface);

/// Nodal loads of a body force b(X), N/m^3, by a rule of 64 points in each element.
Loads body_loads(const fem::QuadraticMesh& mesh,
                 const std::function<Eigen::Vector3d(const Eigen::Vector3d& X)>& force);

/// Sum over the elements of the integral of f(element, shape functions N, X): the same rule.
struct VolumePoint {
  std::size_t element;
  std::array<double, fem::kTetNodes> N;
  std::array<Eigen::Vector3d, fem::kTetNodes> dN;  ///< 1/m
  Eigen::Vector3d X;
  double volume;  ///< weight
};
void for_each_volume_point(const fem::QuadraticMesh& mesh,
                           const std::function<void(const VolumePoint&)>& visit);

/// An unknown of the model and the displacement it is given.
struct Prescribed {
  int unknown;
  double value;
};

/// Moves the unknowns of the model to equilibrium with `loads`; those prescribed get their values
/// in the first step, with the tangent at the given u. Fails the running test when it does not
/// converge to 1e-9 of the forces.
void equilibrate(const fem::SolidModel& model, const Loads& loads,
                 const std::vector<Prescribed>& prescribed, fem::Displacement& u);

}  // namespace palpate::test
