// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/inclusions.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "format/to_index.hpp"

namespace palpate::report {
namespace {

/// Corners of the faces of a tetrahedron of positive volume, counter-clockwise from outside.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// For each region, whether none of its nodes is on the boundary.
std::vector<std::uint8_t> is_inside(const Body& body) {
  std::vector<std::uint8_t> on_boundary(body.nodes.size(), 0);
  for (const Triangle& facet : body.boundary)
    for (const std::int32_t n : facet) on_boundary[to_index(n)] = 1;
  std::vector<std::uint8_t> inside(body.region_names.size(), 1);
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    for (const std::int32_t n : body.tetrahedra[t])
      if (on_boundary[to_index(n)] != 0) inside[to_index(body.tetrahedron_region[t])] = 0;
  }
  return inside;
}

/// The faces of one tetrahedron of the region only.
std::vector<Triangle> surface_of(const Body& body, std::int32_t region) {
  std::map<Triangle, std::pair<Triangle, int>> faces;
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    if (body.tetrahedron_region[t] != region) continue;
    const Tetrahedron& nodes = body.tetrahedra[t];
    for (const auto& corner : kFaces) {
      const Triangle face{nodes[corner[0]], nodes[corner[1]], nodes[corner[2]]};
      Triangle key = face;
      std::sort(key.begin(), key.end());
      auto& entry = faces[key];
      entry.first = face;
      ++entry.second;
    }
  }
  std::vector<Triangle> surface;
  for (const auto& [key, entry] : faces)
    if (entry.second == 1) surface.push_back(entry.first);
  return surface;
}

}  // namespace

std::vector<Inclusion> inclusions(const Body& body) {
  const std::vector<std::uint8_t> inside = is_inside(body);
  std::vector<Inclusion> result;
  for (std::size_t r = 0; r < inside.size(); ++r) {
    if (inside[r] == 0) continue;
    Inclusion inclusion{static_cast<std::int32_t>(r), {}, {}};
    std::map<std::int32_t, std::int32_t> own;
    for (Triangle facet : surface_of(body, inclusion.region)) {
      for (std::int32_t& n : facet) {
        const auto number = static_cast<std::int32_t>(inclusion.node.size());
        const auto [entry, is_first] = own.try_emplace(n, number);
        if (is_first) inclusion.node.push_back(n);
        n = entry->second;
      }
      inclusion.facets.push_back(facet);
    }
    if (!inclusion.facets.empty()) result.push_back(std::move(inclusion));
  }
  return result;
}

}  // namespace palpate::report
