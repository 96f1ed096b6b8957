// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/touch.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "app/report/embed.hpp"
#include "format/deformation.hpp"
#include "format/flat_library.hpp"
#include "format/skin_mesh.hpp"
#include "format/to_index.hpp"

namespace palpate::report {
namespace {

bool has_response(const NodeResponse& response) {
  return response.status != ResponseStatus::Hole;
}

/// The skin vertex of each of these nodes of the boundary.
std::vector<std::int32_t> skin_vertices(const SkinMesh& skin,
                                        const std::vector<std::int32_t>& nodes) {
  std::vector<std::int32_t> rows;
  for (const std::int32_t node : nodes) {
    const auto found = std::lower_bound(skin.node.begin(), skin.node.end(), node);
    rows.push_back(static_cast<std::int32_t>(found - skin.node.begin()));
  }
  return rows;
}

/// `rows`: the skin vertex of each point of the picture; none where the skin is another one.
nlohmann::json skin_data(const Library& library, std::string_view bytes,
                         const std::function<std::vector<std::int32_t>(const Deformation&)>& rows) {
  if (bytes.empty()) return nullptr;
  const auto refused = [&](const char* problem) {
    return nlohmann::json{{"problem", problem}, {"bytes", bytes.size()}, {"limit", kLargestSkin}};
  };
  const Deformation deformation = read_deformation(bytes, "deformation.pdef");
  if (deformation.surface != surface_digest(library.positions, library.triangles))
    return refused("other_library");
  const std::vector<std::int32_t> of_point = rows(deformation);
  if (of_point.empty()) return refused("other_skin");
  if (bytes.size() > kLargestSkin) return refused("too_large");
  return {{"file", packed_column(bytes)}, {"of_point", index_column(of_point)}};
}

}  // namespace

nlohmann::json touch_data(const Library& library) {
  const auto& responses = library.responses;
  if (runtime_wasm().empty() || std::none_of(responses.begin(), responses.end(), has_response))
    return nullptr;
  return {{"runtime", packed_column(runtime_wasm())},
          {"library", packed_column(flat_bytes(library, "the library of the report"))},
          {"skin", nullptr}};
}

nlohmann::json touch_data(const Body& body, const Library& library, std::string_view deformation,
                          const std::vector<std::int32_t>& points) {
  nlohmann::json data = touch_data(library);
  if (data.is_null()) return data;
  data["skin"] = skin_data(library, deformation, [&](const Deformation& d) {
    const SkinMesh skin = skin_mesh(body);
    return d.positions.size() == skin.node.size() ? skin_vertices(skin, points)
                                                  : std::vector<std::int32_t>();
  });
  return data;
}

nlohmann::json touch_data(const Library& library, std::string_view deformation,
                          const std::vector<std::int32_t>& vertices) {
  nlohmann::json data = touch_data(library);
  if (data.is_null()) return data;
  data["skin"] = skin_data(library, deformation, [&](const Deformation& d) {
    std::vector<std::int32_t> rows;
    for (const std::int32_t vertex : vertices) rows.push_back(d.vertex_of.at(to_index(vertex)));
    return rows;
  });
  return data;
}

}  // namespace palpate::report
