// SPDX-License-Identifier: AGPL-3.0-or-later
// Whether the pressures of neighbouring elements agree: near nu = 1/2 element-constant pressures
// can alternate from element to element (checkerboards) where the displacements are good.
#pragma once

#include <vector>

#include "fem/mesh/quadratic_mesh.hpp"

namespace palpate::fem {

/// Of SmoothPressure::alternation: above it element pressures are not to be read as they are.
inline constexpr double kAlternating = 2;

struct SmoothPressure {
  /// (elements) Pa: means of the projection onto pressures that are linear in each element and
  /// continuous within a region, its mass matrix lumped. It filters checkerboards out.
  std::vector<double> pressure;
  /// What the projection changes, over the spread of the pressures about their mean, both root mean
  /// squares over the volume: 0 for a field that it leaves alone, about 1 for a checkerboard.
  double roughness = 0;
  /// The roughness over that of the projection itself, which is what the mesh leaves unresolved:
  /// about 1.6 for a field of one sign of its changes, whatever the mesh, more with a checkerboard.
  double alternation = 0;
};

/// `pressure`: of each element, Pa.
SmoothPressure smooth_pressure(const QuadraticMesh& mesh, const std::vector<double>& pressure);

}  // namespace palpate::fem
