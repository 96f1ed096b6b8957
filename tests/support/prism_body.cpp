// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/prism_body.hpp"

#include <algorithm>
#include <cmath>

#include "format/edge.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::test {

namespace {

double volume6(const Body& body, const Tetrahedron& t) {
  const auto x = [&](std::size_t c) { return body.nodes[to_index(t[c])]; };
  return dot(cross(x(1) - x(0), x(2) - x(0)), x(3) - x(0));
}

/// The diagonals of the sides start at the smaller number below: neighbours agree on them.
void add_prism(Triangle base, std::int32_t below, std::int32_t above, Body& body) {
  std::sort(base.begin(), base.end());
  const auto [a, b, c] = base;
  for (Tetrahedron t : {Tetrahedron{below + a, below + b, below + c, above + c},
                        Tetrahedron{below + a, below + b, above + b, above + c},
                        Tetrahedron{below + a, above + a, above + b, above + c}}) {
    if (volume6(body, t) < 0) std::swap(t[2], t[3]);
    body.tetrahedra.push_back(t);
  }
}

}  // namespace

Triangulation rings(const std::vector<double>& radii, int sectors) {
  Triangulation mesh;
  mesh.points.push_back({0, 0, 0});
  std::int32_t inner = 0;
  int inner_count = 1;
  for (std::size_t ring = 0; ring < radii.size(); ++ring) {
    const int count = 6 * std::min(static_cast<int>(ring) + 1, sectors);
    const auto outer = static_cast<std::int32_t>(mesh.points.size());
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * M_PI * i / count;
      mesh.points.push_back({radii[ring] * std::cos(angle), radii[ring] * std::sin(angle), 0});
    }
    // Walk around both rings, always advancing on the one that lags in angle.
    const auto out = [&](int i) { return outer + i % count; };
    const auto in = [&](int i) { return inner + i % inner_count; };
    for (int i = 0, j = 0; i < count || (inner_count > 1 && j < inner_count);) {
      const bool advance_outer = inner_count == 1 || j == inner_count ||
                                 (i < count && (2 * i + 1) * inner_count <= (2 * j + 1) * count);
      if (advance_outer) {
        mesh.triangles.push_back({in(j), out(i), out(i + 1)});
        ++i;
      } else {
        mesh.triangles.push_back({in(j), out(i), in(j + 1)});
        ++j;
      }
    }
    inner = outer;
    inner_count = count;
  }
  return mesh;
}

Triangulation octant_of_sphere(int divisions) {
  Triangulation mesh;
  // Rows of ever fewer points, of barycentric coordinates (i, j, divisions - i - j).
  std::vector<std::int32_t> first;
  for (int i = 0; i <= divisions; ++i) {
    first.push_back(static_cast<std::int32_t>(mesh.points.size()));
    for (int j = 0; i + j <= divisions; ++j) {
      const auto part = [&](int k) { return std::sin(0.5 * M_PI * k / divisions); };
      const Vec3 x{part(i), part(j), part(divisions - i - j)};
      mesh.points.push_back((1 / norm(x)) * x);
    }
  }
  for (int i = 0; i < divisions; ++i)
    for (int j = 0; i + j < divisions; ++j) {
      const std::int32_t a = first[to_index(i)] + j, b = first[to_index(i + 1)] + j;
      mesh.triangles.push_back({a, b, a + 1});
      if (i + j + 1 < divisions) mesh.triangles.push_back({b, b + 1, a + 1});
    }
  return mesh;
}

Body make_prisms(const Triangulation& base, int layers,
                 const std::function<Vec3(const Vec3& point, int layer)>& position) {
  Body body;
  body.name = "prisms";
  body.region_names = {"tissue"};
  for (int layer = 0; layer <= layers; ++layer)
    for (const Vec3& point : base.points) body.nodes.push_back(position(point, layer));
  const auto count = static_cast<std::int32_t>(base.points.size());
  for (std::int32_t layer = 0; layer < layers; ++layer)
    for (const Triangle& triangle : base.triangles)
      add_prism(triangle, layer * count, (layer + 1) * count, body);
  body.tetrahedron_region.assign(body.tetrahedra.size(), 0);
  body.boundary = boundary_of(body.tetrahedra);
  return body;
}

void curve_onto_sphere(double radius, Body& body) {
  for (const Edge& ends : edges_of(body.boundary)) {
    const Vec3 a = body.nodes[to_index(ends[0])], b = body.nodes[to_index(ends[1])];
    if (std::min(norm(a), norm(b)) < radius * (1 - 1e-9)) continue;
    const Vec3 middle = a + b;
    body.curved_edges.push_back({ends, (radius / norm(middle)) * middle});
  }
}

}  // namespace palpate::test
