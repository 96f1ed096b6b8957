// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/faults.hpp"

#include <algorithm>

#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/volume/boundary.hpp"
#include "mesher/volume/interfaces.hpp"
#include "mesher/volume/triangle_cloud.hpp"

namespace palpate::mesher {
namespace {

Vec3 middle(const VolumeMesh& mesh, const Tetrahedron& t) {
  Vec3 sum{};
  for (const std::int32_t v : t) sum = sum + mesh.nodes[to_index(v)];
  return 0.25 * sum;
}

std::vector<Vec3> find_islands(const VolumeMesh& mesh) {
  const std::vector<std::int32_t> set = adjacency(mesh.tetrahedra).part;
  const std::int32_t largest = largest_set(mesh, set);
  std::vector<Vec3> islands;
  for (std::size_t t = 0; t < set.size(); ++t)
    if (set[t] != largest) islands.push_back(middle(mesh, mesh.tetrahedra[t]));
  return islands;
}

std::vector<Vec3> find_lost(const VolumeMesh& mesh, const std::vector<Crossing>& interface,
                            const SizeField& far) {
  const TriangleCloud facets(mesh.nodes, interface_facets(mesh));
  std::vector<Vec3> lost;
  for (const Crossing& crossing : interface) {
    const double distance = norm(facets.closest(crossing.point) - crossing.point);
    if (distance > far(crossing.point)) lost.push_back(crossing.point);
  }
  return lost;
}

}  // namespace

Faults find_faults(const VolumeMesh& mesh, const std::vector<Crossing>& interface,
                   const FaultLimits& limits) {
  Faults faults;
  for (const std::int32_t v : pinches(adjacency(mesh.tetrahedra).boundary).nodes)
    faults.pinches.push_back(mesh.nodes[to_index(v)]);
  faults.islands = find_islands(mesh);
  for (const Tetrahedron& t : mesh.tetrahedra) {
    if (measure_quality(mesh.nodes, {t}).largest_dihedral > limits.largest_dihedral)
      faults.flat.push_back(middle(mesh, t));
  }
  faults.lost = find_lost(mesh, interface, limits.far);
  return faults;
}

}  // namespace palpate::mesher
