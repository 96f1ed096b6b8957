// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/block_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "format/to_index.hpp"

namespace palpate::test {

namespace {

using Face = std::array<std::int32_t, 3>;

Face key_of(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

/// Facets of one tetrahedron, seen counter-clockwise from outside.
std::array<Face, 4> facets_of(const Tetrahedron& t) {
  return {{{t[0], t[2], t[1]}, {t[0], t[1], t[3]}, {t[1], t[2], t[3]}, {t[2], t[0], t[3]}}};
}

/// The six tetrahedra of a cell: one for each order of the steps along the axes.
void add_cell(const std::function<std::int32_t(int, int, int)>& node, int i, int j, int k,
              std::vector<Tetrahedron>& tetrahedra) {
  const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int o = 0; o < 6; ++o) {
    int step[3] = {i, j, k};
    Tetrahedron t{node(i, j, k)};
    for (std::size_t s = 0; s < 3; ++s) {
      ++step[orders[o][s]];
      t[s + 1] = node(step[0], step[1], step[2]);
    }
    if (o >= 3) std::swap(t[1], t[2]);  // odd orders are mirror images
    tetrahedra.push_back(t);
  }
}

void add_response_surface(Body& body, double top) {
  std::vector<std::int32_t> response(body.nodes.size(), -1);
  const auto on_top = [&](std::int32_t node) {
    return body.nodes[to_index(node)][2] >= top - 1e-12;
  };
  std::array<double, 4> extent{1e300, -1e300, 1e300, -1e300};
  for (const auto& node : body.nodes)
    extent = {std::min(extent[0], node[0]), std::max(extent[1], node[0]),
              std::min(extent[2], node[1]), std::max(extent[3], node[1])};
  for (const auto& t : body.boundary) {
    if (!on_top(t[0]) || !on_top(t[1]) || !on_top(t[2])) continue;
    Triangle local{};
    for (std::size_t c = 0; c < 3; ++c) {
      auto& index = response[to_index(t[c])];
      if (index < 0) {
        index = static_cast<std::int32_t>(body.response.node.size());
        const Vec3& x = body.nodes[to_index(t[c])];
        const bool rim =
            x[0] == extent[0] || x[0] == extent[1] || x[1] == extent[2] || x[1] == extent[3];
        body.response.node.push_back(t[c]);
        body.response.inward.push_back({0, 0, -1});
        body.response.is_site.push_back(rim ? 0 : 1);
      }
      local[c] = index;
    }
    body.response.triangles.push_back(local);
  }
}

}  // namespace

std::int32_t site_nearest(const Body& body, double x, double y) {
  std::int32_t nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& at = body.nodes[static_cast<std::size_t>(body.response.node[v])];
    const double distance = std::hypot(at[0] - x, at[1] - y);
    if (body.response.is_site[v] == 0 || distance >= least) continue;
    least = distance;
    nearest = static_cast<std::int32_t>(v);
  }
  return nearest;
}

std::vector<Triangle> boundary_of(const std::vector<Tetrahedron>& tetrahedra) {
  std::map<Face, int> uses;
  for (const auto& t : tetrahedra)
    for (const auto& face : facets_of(t)) ++uses[key_of(face)];
  std::vector<Triangle> boundary;
  for (const auto& t : tetrahedra)
    for (const auto& face : facets_of(t))
      if (uses[key_of(face)] == 1) boundary.push_back(face);
  return boundary;
}

Body make_block(const std::vector<double>& x, const std::vector<double>& y,
                const std::vector<double>& z) {
  const auto nx = static_cast<int>(x.size()), ny = static_cast<int>(y.size());
  const auto at = [&](int i, int j, int k) { return (k * ny + j) * nx + i; };
  Body body;
  body.name = "block";
  body.region_names = {"tissue"};
  for (const double zk : z)
    for (const double yj : y)
      for (const double xi : x) body.nodes.push_back({xi, yj, zk});
  for (std::size_t k = 0; k + 1 < z.size(); ++k)
    for (int j = 0; j + 1 < ny; ++j)
      for (int i = 0; i + 1 < nx; ++i) add_cell(at, i, j, static_cast<int>(k), body.tetrahedra);
  body.tetrahedron_region.assign(body.tetrahedra.size(), 0);
  body.boundary = boundary_of(body.tetrahedra);
  for (int node = 0; node < nx * ny; ++node) body.fixed_nodes.push_back(node);
  add_response_surface(body, z.back());
  return body;
}

std::vector<double> even(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i <= count; ++i) values.push_back(low + (high - low) * i / count);
  return values;
}

std::vector<double> graded(double half, double core, double fine, double growth) {
  std::vector<double> positive{0};
  double step = fine;
  while (positive.back() < half * (1 - 1e-12)) {
    if (positive.back() >= core * (1 - 1e-12)) step *= growth;
    positive.push_back(positive.back() + step);
  }
  // Fit the last coordinate to `half` by stretching the graded part only.
  const double end = positive.back();
  for (double& value : positive)
    if (value > core) value = core + (value - core) * (half - core) / (end - core);
  std::vector<double> values;
  for (auto i = positive.size(); i-- > 1;) values.push_back(-positive[i]);
  values.insert(values.end(), positive.begin(), positive.end());
  return values;
}

Body uneven_cube() {
  Body body = make_block(even(0, 1, 2), even(0, 1, 2), even(0, 1, 2));
  body.fixed_nodes.clear();
  for (Vec3& x : body.nodes)
    if (x[0] == 0.5 && x[1] == 0.5 && x[2] == 0.5) x = {0.56, 0.45, 0.53};
  return body;
}

Body graded_block(double half, double core, double fine, double growth) {
  const auto across = graded(half, core, fine, growth);
  std::vector<double> down;
  for (const double x : across)
    if (x <= 0) down.push_back(x);
  return make_block(across, across, down);
}

void deform(Body& body, const std::function<Vec3(const Vec3&)>& map) {
  for (auto& node : body.nodes) node = map(node);
}

}  // namespace palpate::test
