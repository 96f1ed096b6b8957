// SPDX-License-Identifier: AGPL-3.0-or-later
// Whether the pressures of neighbouring elements agree: near nu = 1/2 element-constant pressures
// can alternate from element to element (checkerboards) where the displacements are good.
#pragma once

#include <vector>

#include "fem/mesh/quadratic_mesh.hpp"

namespace palpate::fem {

/// Threshold of SmoothPressure::alternation above which element pressures are not reliable.
inline constexpr double kAlternating = 2;

struct SmoothPressure {
  /// (elements) Pa: means of the projection onto pressures that are linear in each element and
  /// continuous within a region, with a lumped mass matrix. It removes checkerboards.
  std::vector<double> pressure;
  /// Change by the projection over the spread of the pressures about their mean, both root mean
  /// squares over the volume: 0 for a field that it does not change, about 1 for a checkerboard.
  double roughness = 0;
  /// The roughness over that of the projected field, which measures what the mesh does not resolve.
  /// Larger with a checkerboard.
  double alternation = 0;
};

/// `pressure`: of each element, Pa.
SmoothPressure smooth_pressure(const QuadraticMesh& mesh, const std::vector<double>& pressure);

}  // namespace palpate::fem
