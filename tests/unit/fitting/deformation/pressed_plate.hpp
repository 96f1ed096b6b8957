// SPDX-License-Identifier: AGPL-3.0-or-later
// A plate whose skin is finer than its response surface, and whose displacement is a given field.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "fitting/deformation/compress.hpp"
#include "format/body.hpp"
#include "format/library.hpp"
#include "format/skin_mesh.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::fitting {

inline constexpr double kSide = 0.08, kRadius = 0.005, kDeepest = 0.006;
inline const Vec3 kDown{0, 0, -1};

/// 8 x 8 response squares in z = 0, each with 4 x 4 squares of the skin.
struct PressedPlate {
  Body body;
  Library library =
      test::plate(8, kSide, [](const Vec3&) { return test::wall_response(170, 120); });

  PressedPlate() {
    library.tool_shape = "sphere";
    library.tool_radius = kRadius;
    constexpr int n = 32;
    const auto row = [](int i, int j) { return static_cast<std::int32_t>(j * (n + 1) + i); };
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) body.nodes.push_back({kSide * i / n, kSide * j / n, 0});
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        body.boundary.push_back({row(i, j), row(i + 1, j), row(i + 1, j + 1)});
        body.boundary.push_back({row(i, j), row(i + 1, j + 1), row(i, j + 1)});
      }
    body.response.triangles = library.triangles;
    for (const Vec3& x : library.positions) {
      const auto cell = [](double at) { return static_cast<int>(std::lround(at / kSide * n)); };
      body.response.node.push_back(row(cell(x[0]), cell(x[1])));
      body.response.inward.push_back(kDown);
      body.response.is_site.push_back(1);
    }
  }

  std::vector<std::int32_t> all_vertices() const {
    std::vector<std::int32_t> vertices;
    for (std::size_t v = 0; v < library.positions.size(); ++v)
      vertices.push_back(static_cast<std::int32_t>(v));
    return vertices;
  }
};

/// Displacement at x of the skin for a tip that has moved by z down and by q across from c.
using SkinField = std::function<Vec3(const Vec3& x, const Vec3& c, double z, const Vec3& q)>;

inline SiteFields fields_at(const PressedPlate& plate, std::int32_t vertex,
                            const SkinField& field) {
  const SkinMesh skin = skin_mesh(plate.body);
  const Vec3 c = plate.library.positions[static_cast<std::size_t>(vertex)];
  const auto sampled = [&](double z, const Vec3& q) {
    std::vector<float> all;
    for (const Vec3& x : skin.positions)
      for (const double u : field(x, c, z, q)) all.push_back(static_cast<float>(u));
    return all;
  };
  SiteFields fields;
  fields.vertex = vertex;
  for (const double z : {0.001, 0.003, kDeepest}) fields.normal.push_back({z, sampled(z, {})});
  for (const Vec3& d : {Vec3{1, 0, 0}, Vec3{0, 1, 0}}) {
    LateralField lateral{kDeepest, d, 0.002, sampled(kDeepest, 0.002 * d)};
    for (std::size_t i = 0; i < lateral.skin.size(); ++i)
      lateral.skin[i] -= fields.normal.back().skin[i];
    fields.lateral.push_back(lateral);
  }
  return fields;
}

inline Deformation compressed(const PressedPlate& plate, const SkinField& field) {
  return compress(plate.body, plate.library, {"sphere", kRadius, "frictionless"},
                  plate.all_vertices(),
                  [&](std::int32_t vertex) { return fields_at(plate, vertex, field); }, {});
}

/// A dimple that is the same at every contact point.
inline Vec3 dimple(const Vec3& x, const Vec3& c, double z, const Vec3& q) {
  const Vec3 r = x - c;
  const double s = norm(r) / 0.008, fall = std::exp(-s * s);
  return z * fall * kDown - 0.15 * z / 0.008 * fall * r + fall * q;
}

}  // namespace palpate::fitting
