// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/touch.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "app/report/embed.hpp"
#include "format/deformation.hpp"
#include "format/flat_library.hpp"
#include "format/skin_mesh.hpp"

namespace palpate::report {
namespace {

nlohmann::json byte_column(std::string_view bytes) {
  return column(std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
}

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

nlohmann::json skin_data(const Body& body, const Library& library, std::string_view bytes,
                         const std::vector<std::int32_t>& points) {
  if (bytes.empty()) return nullptr;
  const auto refused = [&](const char* problem) {
    return nlohmann::json{{"problem", problem}, {"bytes", bytes.size()}, {"limit", kLargestSkin}};
  };
  const Deformation deformation = read_deformation(bytes, "deformation.pdef");
  const SkinMesh skin = skin_mesh(body);
  if (deformation.surface != surface_digest(library.positions, library.triangles) ||
      deformation.positions.size() != skin.node.size())
    return refused("other_library");
  if (bytes.size() > kLargestSkin) return refused("too_large");
  return {{"file", byte_column(bytes)}, {"of_point", index_column(skin_vertices(skin, points))}};
}

}  // namespace

nlohmann::json touch_data(const Library& library) {
  const auto& responses = library.responses;
  if (runtime_wasm().empty() || std::none_of(responses.begin(), responses.end(), has_response))
    return nullptr;
  return {{"runtime", byte_column(runtime_wasm())},
          {"library", byte_column(flat_bytes(library, "the library of the report"))},
          {"skin", nullptr}};
}

nlohmann::json touch_data(const Body& body, const Library& library, std::string_view deformation,
                          const std::vector<std::int32_t>& points) {
  nlohmann::json data = touch_data(library);
  if (!data.is_null()) data["skin"] = skin_data(body, library, deformation, points);
  return data;
}

}  // namespace palpate::report
