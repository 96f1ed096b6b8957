// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/interfaces.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"

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

std::vector<Triangle> interface_facets(const VolumeMesh& mesh) {
  std::vector<Triangle> facets = boundary_facets(mesh.tetrahedra);
  const std::vector<Face> faces = sorted_faces(mesh.tetrahedra);
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].sorted == faces[i - 1].sorted &&
        mesh.region[faces[i].tetrahedron] != mesh.region[faces[i - 1].tetrahedron]) {
      facets.push_back(faces[i].sorted);
    }
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

namespace {

/// The sets of tetrahedra around a node that are connected by faces with the node.
std::vector<std::size_t> sets_at(const VolumeMesh& mesh, std::int32_t node,
                                 const std::vector<std::size_t>& around) {
  std::vector<std::size_t> parent(around.size());
  std::iota(parent.begin(), parent.end(), 0U);
  std::map<Edge, std::size_t> first_at;  // by the other two nodes of the face
  for (std::size_t i = 0; i < around.size(); ++i) {
    std::vector<std::int32_t> others;
    for (const std::int32_t v : mesh.tetrahedra[around[i]])
      if (v != node) others.push_back(v);
    std::sort(others.begin(), others.end());
    for (const Edge& edge :
         {Edge{others[0], others[1]}, Edge{others[0], others[2]}, Edge{others[1], others[2]}}) {
      const auto [entry, is_new] = first_at.emplace(edge, i);
      if (!is_new) parent[root_of(parent, i)] = root_of(parent, entry->second);
    }
  }
  for (std::size_t i = 0; i < around.size(); ++i) parent[i] = root_of(parent, i);
  return parent;
}

}  // namespace

std::size_t split_nodes(VolumeMesh& mesh) {
  const std::size_t before = mesh.nodes.size();
  std::map<std::int32_t, std::vector<std::size_t>> around;
  for (const std::int32_t v : non_manifold_nodes(boundary_facets(mesh.tetrahedra))) around[v];
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const std::int32_t v : mesh.tetrahedra[t]) {
      const auto found = around.find(v);
      if (found != around.end()) found->second.push_back(t);
    }
  }
  for (const auto& [node, tetrahedra] : around) {
    const std::vector<std::size_t> set = sets_at(mesh, node, tetrahedra);
    std::map<std::size_t, std::int32_t> name{{set.front(), node}};
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto next = static_cast<std::int32_t>(mesh.nodes.size());
      const auto [entry, is_new] = name.emplace(set[i], next);
      if (is_new) mesh.nodes.push_back(Vec3(mesh.nodes[to_index(node)]));
      for (std::int32_t& v : mesh.tetrahedra[tetrahedra[i]])
        if (v == node) v = entry->second;
    }
  }
  return mesh.nodes.size() - before;
}

}  // namespace palpate::mesher
