// SPDX-License-Identifier: Apache-2.0
#include "format/skin_mesh.hpp"

#include <algorithm>

#include "format/to_index.hpp"

namespace palpate {

SkinMesh skin_mesh(const Body& body) {
  SkinMesh skin;
  for (const Triangle& facet : body.boundary)
    skin.node.insert(skin.node.end(), facet.begin(), facet.end());
  std::sort(skin.node.begin(), skin.node.end());
  skin.node.erase(std::unique(skin.node.begin(), skin.node.end()), skin.node.end());
  const auto row = [&](std::int32_t node) {
    const auto found = std::lower_bound(skin.node.begin(), skin.node.end(), node);
    return static_cast<std::int32_t>(found - skin.node.begin());
  };
  for (const std::int32_t node : skin.node) skin.positions.push_back(body.nodes[to_index(node)]);
  for (const Triangle& f : body.boundary)
    skin.triangles.push_back({row(f[0]), row(f[1]), row(f[2])});
  for (const std::int32_t node : body.response.node) skin.vertex_of.push_back(row(node));
  return skin;
}

}  // namespace palpate
