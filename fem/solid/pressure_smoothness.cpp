// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/pressure_smoothness.hpp"

#include <cmath>
#include <numeric>

#include "fem/solid/nodal_pressure.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Element means of the projection, and the roughness.
SmoothPressure project(const QuadraticMesh& mesh, const NodalPressure& nodal,
                       const std::vector<double>& pressure) {
  std::vector<double> at_point(nodal.points().size(), 0.0);
  double volume = 0, mean = 0;
  for (const int e : nodal.elements()) {
    const double V = volume_of(mesh, e);
    volume += V;
    mean += V * pressure[to_index(e)];
    for (const int point : nodal.points_of(mesh, e))
      at_point[to_index(point)] +=
          0.25 * V * pressure[to_index(e)] / nodal.points()[to_index(point)].volume;
  }
  mean /= volume;
  SmoothPressure smooth;
  double changed = 0, spread = 0;
  for (const int e : nodal.elements()) {
    double sum = 0;
    for (const int point : nodal.points_of(mesh, e)) sum += 0.25 * at_point[to_index(point)];
    smooth.pressure.push_back(sum);
    const double V = volume_of(mesh, e), p = pressure[to_index(e)];
    changed += V * (p - sum) * (p - sum);
    spread += V * (p - mean) * (p - mean);
  }
  smooth.roughness = spread > 0 ? std::sqrt(changed / spread) : 0;
  return smooth;
}

}  // namespace

SmoothPressure smooth_pressure(const QuadraticMesh& mesh, const std::vector<double>& pressure) {
  std::vector<int> all(mesh.tetrahedra.size());
  std::iota(all.begin(), all.end(), 0);
  const NodalPressure nodal(mesh, all, std::vector<int>(to_index(mesh.nodes()), -1));
  SmoothPressure smooth = project(mesh, nodal, pressure);
  const double unresolved = project(mesh, nodal, smooth.pressure).roughness;
  smooth.alternation = unresolved > 0 ? smooth.roughness / unresolved : 0;
  return smooth;
}

}  // namespace palpate::fem
