// SPDX-License-Identifier: AGPL-3.0-or-later
// Faces as a file lists them, from shapes of known geometry.
#pragma once

#include <cstddef>
#include <vector>

#include "mesher/geometry/soup.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher::test {

inline Soup soup_of(const Surface& surface) {
  Soup soup;
  soup.points = surface.points;
  for (const Triangle& t : surface.triangles) {
    std::vector<std::size_t> corners;
    for (const std::int32_t v : t) corners.push_back(static_cast<std::size_t>(v));
    soup.polygons.push_back(corners);
  }
  return soup;
}

/// Every triangle with corners of its own, as in an STL file.
inline Soup unconnected(const Surface& surface) {
  Soup soup;
  for (const Triangle& t : surface.triangles) {
    const std::size_t first = soup.points.size();
    for (const std::int32_t v : t)
      soup.points.push_back(surface.points[static_cast<std::size_t>(v)]);
    soup.polygons.push_back({first, first + 1, first + 2});
  }
  return soup;
}

inline Surface joined(Surface surface, const Surface& more) {
  append(surface, more);
  return surface;
}

/// Without the triangles whose corners all satisfy `is_dropped`.
template <typename Predicate>
Surface without(Surface surface, const Predicate& is_dropped) {
  std::erase_if(surface.triangles, [&](const Triangle& t) {
    for (const std::int32_t v : t)
      if (!is_dropped(surface.points[static_cast<std::size_t>(v)])) return false;
    return true;
  });
  return surface;
}

/// With a point in the middle of an edge: one of the three faces there has no area.
inline Surface with_a_face_of_no_area(Surface surface) {
  const auto [a, b, c] = surface.triangles[0];
  const auto middle = static_cast<std::int32_t>(surface.points.size());
  const Vec3 place = 0.5 * (surface.points[static_cast<std::size_t>(a)] +
                            surface.points[static_cast<std::size_t>(b)]);
  surface.points.push_back(place);
  surface.triangles[0] = {a, middle, c};
  surface.triangles.push_back({middle, b, c});
  surface.triangles.push_back({a, b, middle});
  return surface;
}

}  // namespace palpate::mesher::test
