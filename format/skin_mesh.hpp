// SPDX-License-Identifier: Apache-2.0
// The outer surface of a body as a mesh of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "format/body.hpp"
#include "format/vec3.hpp"

namespace palpate {

/// The corners of the boundary facets of a body, finer than the response surface, whose vertices
/// are among them. Curved edges are straight here.
struct SkinMesh {
  std::vector<std::int32_t> node;       ///< (W) index into Body::nodes, ascending
  std::vector<Vec3> positions;          ///< (W) m
  std::vector<Triangle> triangles;      ///< rows of `node`; counter-clockwise from outside
  std::vector<std::int32_t> vertex_of;  ///< (V) the skin vertex of each response vertex
};

SkinMesh skin_mesh(const Body& body);

}  // namespace palpate
