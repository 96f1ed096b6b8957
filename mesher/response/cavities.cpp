// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/response/cavities.hpp"

#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

/// The triangles that are connected with the first one by vertices; they are marked.
Surface part_of(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                const std::vector<std::vector<std::int32_t>>& around, std::size_t first,
                std::vector<char>& is_done) {
  Surface part;
  part.points = points;
  std::vector<std::size_t> ahead{first};
  is_done[first] = 1;
  while (!ahead.empty()) {
    const Triangle& triangle = triangles[ahead.back()];
    ahead.pop_back();
    part.triangles.push_back(triangle);
    for (const std::int32_t v : triangle) {
      for (const std::int32_t next : around[to_index(v)]) {
        if (is_done[to_index(next)] != 0) continue;
        is_done[to_index(next)] = 1;
        ahead.push_back(to_index(next));
      }
    }
  }
  return part;
}

}  // namespace

void exclude_cavities(Body& body, const Surface& boundary, const Log& log) {
  const std::vector<Triangle>& triangles = body.response.triangles;
  const auto around = incident_triangles(boundary.points.size(), triangles);
  std::vector<char> is_done(triangles.size(), 0);
  std::size_t cavities = 0, sites = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (is_done[t] != 0) continue;
    const Surface part = part_of(boundary.points, triangles, around, t, is_done);
    if (signed_volume(part) >= 0) continue;
    ++cavities;
    for (const Triangle& triangle : part.triangles) {
      for (const std::int32_t v : triangle) {
        sites += body.response.is_site[to_index(v)];
        body.response.is_site[to_index(v)] = 0;
      }
    }
  }
  if (cavities > 0) {
    note(log,
         text(counted(sites, "vertex", "vertices"), " of the response surface in ",
              counted(cavities, "cavity", "cavities"), ", which no tool reaches, are no sites"));
  }
}

}  // namespace palpate::mesher
