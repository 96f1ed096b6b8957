// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/play_page.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "app/report/embed.hpp"
#include "app/report/figures.hpp"
#include "app/report/page_data.hpp"
#include "app/report/report.hpp"
#include "app/report/surface_map.hpp"
#include "app/report/touch.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::report {
namespace {

using nlohmann::json;

/// As the page has them: what can be pressed, and what cannot.
constexpr std::uint8_t kPressed = 0, kNotPressed = 1;

bool responds(const Library& library, std::int32_t vertex) {
  return library.responses[to_index(vertex)].status != ResponseStatus::Hole;
}

double depth_of(const Library& library) {
  if (library.certificate.depth > 0) return library.certificate.depth;
  double depth = kInfinity;
  for (const NodeResponse& node : library.responses)
    if (node.status != ResponseStatus::Hole)
      depth = std::min(depth, static_cast<double>(node.normal.knot.back()));
  return depth;
}

std::vector<float> columns_of(const std::vector<Vec3>& points) {
  std::vector<float> out;
  for (const Vec3& point : points)
    for (const double x : point) out.push_back(static_cast<float>(x));
  return out;
}

/// A part of the vertices, with a numbering of its own.
struct Numbering {
  std::vector<std::int32_t> vertex;  ///< of each point
  std::vector<std::int32_t> point;   ///< of each vertex; -1: none
};
Numbering corners_of(const std::vector<Triangle>& triangles, std::size_t vertices) {
  Numbering used{{}, std::vector<std::int32_t>(vertices, -1)};
  for (const Triangle& t : triangles) {
    for (const std::int32_t v : t) {
      if (used.point.at(to_index(v)) >= 0) continue;
      used.point[to_index(v)] = static_cast<std::int32_t>(used.vertex.size());
      used.vertex.push_back(v);
    }
  }
  return used;
}

/// The response surface in place of the boundary of the body: its points are vertices.
json surface_of(const Library& library, const std::vector<Triangle>& triangles,
                const Numbering& used) {
  std::vector<Vec3> points;
  for (const std::int32_t v : used.vertex) points.push_back(library.positions[to_index(v)]);
  const std::vector<std::int32_t> in_library = library_triangles(triangles, library);
  std::vector<std::int32_t> facets, corners, own, point_triangle(points.size());
  std::vector<double> natural(2 * points.size());
  std::vector<std::uint8_t> kind;
  for (std::size_t m = 0; m < triangles.size(); ++m) {
    bool pressed = in_library[m] >= 0;
    for (std::size_t l = 0; l < 3; ++l) {
      const std::int32_t v = triangles[m][l];
      const std::size_t p = to_index(used.point[to_index(v)]);
      corners.push_back(v);
      facets.push_back(static_cast<std::int32_t>(p));
      point_triangle[p] = static_cast<std::int32_t>(m);
      natural[2 * p] = l == 0 ? 1 : 0;
      natural[2 * p + 1] = l == 1 ? 1 : 0;
      pressed = pressed && responds(library, v);
    }
    kind.push_back(pressed ? kPressed : kNotPressed);
    own.push_back(static_cast<std::int32_t>(m));
  }
  return {{"points", column(columns_of(points))},
          {"facets", index_column(facets)},
          {"facet_triangle", index_column(own)},
          {"facet_kind", column(kind)},
          {"point_triangle", index_column(point_triangle)},
          {"point_natural", fraction_column(natural)},
          {"triangles", index_column(corners)},
          {"library_triangle", column(in_library)}};
}

json inclusions_of(const std::vector<InnerSurface>& inclusions) {
  json list = json::array();
  for (const InnerSurface& inclusion : inclusions) {
    std::vector<std::int32_t> facets;
    for (const Triangle& t : inclusion.facets) facets.insert(facets.end(), t.begin(), t.end());
    list.push_back({{"region", inclusion.region},
                    {"points", column(columns_of(inclusion.points))},
                    {"facets", index_column(facets)}});
  }
  return list;
}

/// What the picture shows: "surface", "inclusions" and "touch".
json picture_of(const Library& library, const PlayBody& drawn) {
  if (drawn.body == nullptr) {
    const auto& triangles = drawn.triangles.empty() ? library.triangles : drawn.triangles;
    const Numbering used = corners_of(triangles, library.positions.size());
    return {{"surface", surface_of(library, triangles, used)},
            {"inclusions", inclusions_of(drawn.inclusions)},
            {"touch", touch_data(library, drawn.deformation, used.vertex)}};
  }
  const Body& body = *drawn.body;
  if (body.response.node.size() != library.positions.size())
    refuse(library.name, "the body beside it is not the one that it was computed for",
           "move body.h5 away, or run `palpate build` again");
  const SurfaceMap map = map_boundary(body);
  return {{"surface", surface_data(body, library, map)},
          {"inclusions", inclusion_data(body)},
          {"touch", touch_data(body, library, drawn.deformation, map.node)}};
}

json vertices_of(const Library& library) {
  std::vector<std::uint8_t> status;
  for (const NodeResponse& response : library.responses)
    status.push_back(static_cast<std::uint8_t>(response.status));
  return {{"position", column(columns_of(library.positions))},
          {"inward", column(columns_of(library.inward))},
          {"response_status", column(status)}};
}

}  // namespace

json play_data(const Library& library, const PlayBody& drawn) {
  const auto responds_at_all = [](const NodeResponse& node) {
    return node.status != ResponseStatus::Hole;
  };
  if (std::none_of(library.responses.begin(), library.responses.end(), responds_at_all))
    refuse(library.name, "no vertex of the library has a response",
           "look at the failed sites with `palpate inspect`");
  const double depth = depth_of(library);
  const std::vector<PeakForce> no_samples(library.responses.size());
  const ChosenVertices chosen = choose_vertices(library, no_samples, depth);
  json data{
      {"play", true},
      {"title", library.name},
      {"key",
       {{"depth", depth},
        {"deepest", depth},
        {"tool_shape", library.tool_shape},
        {"tool_radius", library.tool_radius}}},
      {"vertices", vertices_of(library)},
      {"normal", response_columns(library, true)},
      {"chosen",
       {{"softest", chosen.softest}, {"median", chosen.median}, {"stiffest", chosen.stiffest}}},
      {"certificate", certificate_data(library)},
      {"relaxation", relaxation_data(library, chosen.median)},
      {"provenance", provenance_data(library.provenance.steps)}};
  data.update(picture_of(library, drawn));
  return data;
}

void write_play_page(const Library& library, const PlayBody& drawn,
                     const std::filesystem::path& path) {
  const json data = play_data(library, drawn);
  if (data["touch"].is_null())
    refuse("play", "this palpate was built without the WebAssembly toolchain, which the page needs",
           "run scripts/setup and build again");
  write_page(data, path);
}

json watch_data(const Library& library, const PlayBody& drawn) {
  json data = play_data(library, drawn);
  data["watch"] = true;
  return data;
}

std::string watch_page(const Library& library, const PlayBody& drawn) {
  std::string page = page_text(watch_data(library, drawn));
  constexpr std::string_view kPolicy = "default-src 'none';";
  const std::size_t at = page.find(kPolicy);
  if (at == std::string::npos)
    throw Error(ErrorKind::Internal, "watch", "the page has no content security policy",
                "report it as a defect");
  page.insert(at + kPolicy.size(), " connect-src 'self';");
  return page;
}

}  // namespace palpate::report
