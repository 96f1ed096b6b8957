// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/split_edges.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "format/edge.hpp"
#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

/// The triangles that replace one, whose point on the edge from corner k to the next is on[k], or
/// -1.
std::vector<Triangle> parts_of(const Triangle& corner, const std::array<std::int32_t, 3>& on) {
  const auto c = [&](std::size_t k) { return corner[k % 3]; };
  const auto has_point = [](std::int32_t v) { return v >= 0; };
  const auto count = std::count_if(on.begin(), on.end(), has_point);
  if (count == 0) return {corner};
  if (count == 3)
    return {
        {c(0), on[0], on[2]}, {c(1), on[1], on[0]}, {c(2), on[2], on[1]}, {on[0], on[1], on[2]}};
  if (count == 1) {
    const auto k =
        static_cast<std::size_t>(std::find_if(on.begin(), on.end(), has_point) - on.begin());
    return {{c(k), on[k], c(k + 2)}, {on[k], c(k + 1), c(k + 2)}};
  }
  const auto k =
      static_cast<std::size_t>(std::find_if_not(on.begin(), on.end(), has_point) - on.begin());
  const std::int32_t p = on[(k + 1) % 3], q = on[(k + 2) % 3];
  return {{p, c(k + 2), q}, {c(k), c(k + 1), p}, {c(k), p, q}};
}

}  // namespace

void split_edges(Surface& surface, const std::map<Edge, Vec3>& points) {
  if (points.empty()) return;
  std::map<Edge, std::int32_t> index;
  for (const auto& [edge, point] : points) {
    index.emplace(edge, static_cast<std::int32_t>(surface.points.size()));
    surface.points.push_back(point);
  }
  std::vector<Triangle> triangles;
  std::vector<std::size_t> names;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& corner = surface.triangles[t];
    std::array<std::int32_t, 3> on{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = index.find(edge_between(corner[k], corner[(k + 1) % 3]));
      on[k] = found == index.end() ? -1 : found->second;
    }
    for (const Triangle& part : parts_of(corner, on)) {
      triangles.push_back(part);
      if (!surface.names.empty()) names.push_back(surface.names[t]);
    }
  }
  surface.triangles = std::move(triangles);
  surface.names = std::move(names);
}

}  // namespace palpate::mesher
