// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/preview.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "app/report/embed.hpp"
#include "app/report/page_data.hpp"
#include "app/report/repair_file.hpp"
#include "app/report/report.hpp"
#include "app/report/surface_map.hpp"
#include "format/to_index.hpp"

namespace palpate::report {
namespace {

using nlohmann::json;

/// The kinds of facets of the picture, as in the report.
enum Kind : std::uint8_t { Pressed = 0, NotPressed = 1, Supported = 2 };

/// Response status of the page: vertices with this one are drawn as no node.
constexpr std::uint8_t kNoNode = 2;

std::vector<std::uint8_t> facet_kinds(const Body& body, const SurfaceMap& map) {
  std::vector<std::uint8_t> fixed(body.nodes.size(), 0), kinds;
  for (const std::int32_t n : body.fixed_nodes) fixed.at(to_index(n)) = 1;
  for (std::size_t f = 0; f < map.facets.size(); ++f) {
    const Triangle& facet = body.boundary[f];
    const bool is_fixed = std::all_of(facet.begin(), facet.end(),
                                      [&](std::int32_t n) { return fixed[to_index(n)] != 0; });
    const std::int32_t m = map.facet_triangle[f];
    bool pressed = m >= 0;
    if (pressed)
      for (const std::int32_t v : body.response.triangles[to_index(m)])
        pressed = pressed && body.response.is_site[to_index(v)] != 0;
    kinds.push_back(is_fixed ? Supported : pressed ? Pressed : NotPressed);
  }
  for (const SprungFacet& sprung : body.foundation) kinds.at(to_index(sprung.facet)) = Supported;
  return kinds;
}

void add_point(std::vector<float>& out, const Vec3& v) {
  for (const double x : v) out.push_back(static_cast<float>(x));
}

json vertex_data(const Body& body) {
  std::vector<float> position;
  std::vector<std::uint8_t> status;
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    add_point(position, body.nodes[to_index(body.response.node[v])]);
    status.push_back(body.response.is_site[v] != 0 ? 0 : kNoNode);
  }
  return {{"position", column(position)}, {"response_status", column(status)}};
}

/// m, at each point of the map; null where repair moved nothing or the file is of another surface.
json distance_data(const Body& body, const SurfaceMap& map, const std::string& repair) {
  const auto repaired = repaired_surface(repair, body.provenance);
  if (!repaired) return nullptr;
  std::vector<Vec3> points;
  for (const std::int32_t n : map.node) points.push_back(body.nodes[to_index(n)]);
  const std::vector<double> moved =
      nearest_values(points, repaired->points, repaired->triangles, repaired->distance);
  return column(std::vector<float>(moved.begin(), moved.end()));
}

}  // namespace

json preview_data(const Body& body, const std::string& repair) {
  const SurfaceMap map = map_boundary(body);
  std::vector<float> points;
  std::vector<std::int32_t> facets;
  for (const std::int32_t n : map.node) add_point(points, body.nodes[to_index(n)]);
  for (const Triangle& t : map.facets) facets.insert(facets.end(), t.begin(), t.end());
  return {{"preview", true},
          {"title", body.name},
          {"body", body_data(body)},
          {"surface",
           {{"points", column(points)},
            {"facets", index_column(facets)},
            {"facet_kind", column(facet_kinds(body, map))}}},
          {"sprung_facets", body.foundation.size()},
          {"inclusions", inclusion_data(body)},
          {"vertices", vertex_data(body)},
          {"distance", distance_data(body, map, repair)}};
}

void write_preview(const Body& body, const std::string& repair, const std::filesystem::path& path) {
  write_page(preview_data(body, repair), path);
}

}  // namespace palpate::report
