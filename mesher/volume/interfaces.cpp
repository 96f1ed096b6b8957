// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/interfaces.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/volume/boundary.hpp"

namespace palpate::mesher {

std::vector<Triangle> interface_facets(const VolumeMesh& mesh) {
  const Adjacency joined = adjacency(mesh.tetrahedra);
  std::vector<Triangle> facets = joined.boundary;
  for (const SharedFace& face : joined.shared)
    if (mesh.region[to_index(face.tetrahedra[0])] != mesh.region[to_index(face.tetrahedra[1])])
      facets.push_back(face.corners);
  return facets;
}

Surface boundary_surface(const VolumeMesh& mesh) {
  Surface surface;
  surface.triangles = adjacency(mesh.tetrahedra).boundary;
  std::vector<std::int32_t> number(mesh.nodes.size(), -1);
  for (const Triangle& t : surface.triangles)
    for (const std::int32_t v : t) number[to_index(v)] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<std::int32_t>(surface.points.size());
    surface.points.push_back(mesh.nodes[v]);
  }
  for (Triangle& t : surface.triangles)
    for (std::int32_t& v : t) v = number[to_index(v)];
  return surface;
}

std::int32_t largest_set(const VolumeMesh& mesh, const std::vector<std::int32_t>& set) {
  std::map<std::int32_t, double> size;
  for (std::size_t t = 0; t < set.size(); ++t)
    size[set[t]] += volume(mesh.nodes, mesh.tetrahedra[t]);
  const auto largest = std::max_element(
      size.begin(), size.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return largest == size.end() ? -1 : largest->first;
}

void keep_set(VolumeMesh& mesh, const std::vector<std::int32_t>& set, std::int32_t kept) {
  VolumeMesh part;
  std::vector<std::int32_t> number(mesh.nodes.size(), -1);
  for (std::size_t t = 0; t < set.size(); ++t) {
    if (set[t] != kept) continue;
    Tetrahedron corners = mesh.tetrahedra[t];
    for (std::int32_t& v : corners) {
      std::int32_t& n = number[to_index(v)];
      if (n < 0) {
        n = static_cast<std::int32_t>(part.nodes.size());
        part.nodes.push_back(mesh.nodes[to_index(v)]);
      }
      v = n;
    }
    part.tetrahedra.push_back(corners);
    part.region.push_back(mesh.region[t]);
  }
  mesh.nodes = std::move(part.nodes);
  mesh.tetrahedra = std::move(part.tetrahedra);
  mesh.region = std::move(part.region);
}

}  // namespace palpate::mesher
