// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/interfaces.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

/// The faces of a positive tetrahedron, oriented outward.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct Face {
  Triangle sorted{};
  std::size_t tetrahedron = 0, side = 0;
};

/// Every face of every tetrahedron; the two sides of a face are neighbours in the list.
std::vector<Face> sorted_faces(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<Face> faces;
  faces.reserve(4 * tetrahedra.size());
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    for (std::size_t side = 0; side < 4; ++side) {
      const auto& [a, b, c] = kFaces[side];
      Face face{{tetrahedra[t][a], tetrahedra[t][b], tetrahedra[t][c]}, t, side};
      std::sort(face.sorted.begin(), face.sorted.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::tie(a.sorted, a.tetrahedron) < std::tie(b.sorted, b.tetrahedron);
  });
  return faces;
}

/// The root of a set in a forest of parents, with the path to it halved.
std::size_t root_of(std::vector<std::size_t>& parent, std::size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Facets around each node are one sheet when all of them are connected by edges at the node.
bool is_one_sheet(const std::vector<Triangle>& boundary, const std::vector<std::int32_t>& facets,
                  std::int32_t node) {
  std::vector<std::size_t> parent(facets.size());
  std::iota(parent.begin(), parent.end(), 0U);
  std::map<std::int32_t, std::size_t> first_at;  // by the other end of the edge
  for (std::size_t i = 0; i < facets.size(); ++i) {
    for (const std::int32_t other : boundary[to_index(facets[i])]) {
      if (other == node) continue;
      const auto [entry, is_new] = first_at.emplace(other, i);
      if (!is_new) parent[root_of(parent, i)] = root_of(parent, entry->second);
    }
  }
  const std::size_t root = root_of(parent, 0);
  for (std::size_t i = 1; i < facets.size(); ++i)
    if (root_of(parent, i) != root) return false;
  return true;
}

}  // namespace

std::vector<Triangle> boundary_facets(const std::vector<Tetrahedron>& tetrahedra) {
  const std::vector<Face> faces = sorted_faces(tetrahedra);
  std::vector<std::pair<std::size_t, std::size_t>> alone;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool before = i > 0 && faces[i - 1].sorted == faces[i].sorted;
    const bool after = i + 1 < faces.size() && faces[i + 1].sorted == faces[i].sorted;
    if (!before && !after) alone.emplace_back(faces[i].tetrahedron, faces[i].side);
  }
  std::sort(alone.begin(), alone.end());
  std::vector<Triangle> facets;
  for (const auto& [t, side] : alone) {
    const auto& [a, b, c] = kFaces[side];
    facets.push_back({tetrahedra[t][a], tetrahedra[t][b], tetrahedra[t][c]});
  }
  return facets;
}

Surface boundary_surface(const VolumeMesh& mesh) {
  Surface surface;
  surface.triangles = boundary_facets(mesh.tetrahedra);
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

std::vector<std::int32_t> non_manifold_nodes(const std::vector<Triangle>& boundary) {
  std::map<Edge, int> facets_of;
  std::int32_t last = -1;
  for (const Triangle& t : boundary) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      ++facets_of[{low, high}];
      last = std::max(last, t[k]);
    }
  }
  std::vector<std::int32_t> faulty;
  for (const auto& [edge, count] : facets_of)
    if (count != 2) faulty.insert(faulty.end(), edge.begin(), edge.end());
  const auto around = incident_triangles(to_index(last + 1), boundary);
  for (std::int32_t v = 0; v <= last; ++v) {
    const auto& facets = around[to_index(v)];
    if (!facets.empty() && !is_one_sheet(boundary, facets, v)) faulty.push_back(v);
  }
  std::sort(faulty.begin(), faulty.end());
  faulty.erase(std::unique(faulty.begin(), faulty.end()), faulty.end());
  return faulty;
}

std::vector<std::int32_t> connected_sets(const std::vector<Tetrahedron>& tetrahedra) {
  const std::vector<Face> faces = sorted_faces(tetrahedra);
  std::vector<std::size_t> parent(tetrahedra.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].sorted != faces[i - 1].sorted) continue;
    parent[root_of(parent, faces[i].tetrahedron)] = root_of(parent, faces[i - 1].tetrahedron);
  }
  std::map<std::size_t, std::int32_t> number;
  std::vector<std::int32_t> set;
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    const auto next = static_cast<std::int32_t>(number.size());
    set.push_back(number.emplace(root_of(parent, t), next).first->second);
  }
  return set;
}

}  // namespace palpate::mesher
