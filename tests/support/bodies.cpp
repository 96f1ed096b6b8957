// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/bodies.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "format/edge.hpp"

namespace palpate::test {
namespace {

Vec3 unit(const Vec3& a) {
  return (1.0 / norm(a)) * a;
}

struct Shell {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

Shell icosahedron() {
  const double p = std::numbers::phi;
  Shell s;
  for (const Vec3& v : {Vec3{-1, p, 0},
                        {1, p, 0},
                        {-1, -p, 0},
                        {1, -p, 0},
                        {0, -1, p},
                        {0, 1, p},
                        {0, -1, -p},
                        {0, 1, -p},
                        {p, 0, -1},
                        {p, 0, 1},
                        {-p, 0, -1},
                        {-p, 0, 1}}) {
    s.points.push_back(unit(v));
  }
  s.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return s;
}

Shell subdivide(const Shell& coarse) {
  Shell fine{coarse.points, {}};
  std::map<Edge, std::int32_t> middle;
  const auto between = [&](std::int32_t a, std::int32_t b) {
    const auto [it, is_new] =
        middle.emplace(edge_between(a, b), static_cast<std::int32_t>(fine.points.size()));
    if (is_new) {
      fine.points.push_back(unit(fine.points[static_cast<std::size_t>(a)] +
                                 fine.points[static_cast<std::size_t>(b)]));
    }
    return it->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::int32_t ab = between(a, b);
    const std::int32_t bc = between(b, c);
    const std::int32_t ca = between(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) {
      fine.triangles.push_back(t);
    }
  }
  return fine;
}

Library finish(std::vector<Vec3> positions, std::vector<Vec3> inward,
               std::vector<Triangle> triangles, const Responses& responses) {
  Library library;
  library.name = "test body";
  library.tool_shape = "sphere";
  library.tool_radius = 0.002;
  for (const Vec3& x : positions) library.responses.push_back(responses(x));
  library.positions = std::move(positions);
  library.inward = std::move(inward);
  library.triangles = std::move(triangles);
  return library;
}

std::vector<Vec3> mesh_normals(const std::vector<Vec3>& points,
                               const std::vector<Triangle>& triangles) {
  std::vector<Vec3> sum(points.size(), Vec3{});
  for (const Triangle& t : triangles) {
    const auto at = [&](std::size_t l) { return points[static_cast<std::size_t>(t[l])]; };
    const Vec3 outward = cross(at(1) - at(0), at(2) - at(0));
    for (const std::int32_t v : t) {
      sum[static_cast<std::size_t>(v)] = sum[static_cast<std::size_t>(v)] - outward;
    }
  }
  for (Vec3& n : sum) n = unit(n);
  return sum;
}

/// Triangles of a grid of (columns + 1) x (rows + 1) vertices, or of `columns` x (rows + 1) when it
/// closes on itself.
std::vector<Triangle> grid(int columns, int rows, bool closed) {
  const int stride = closed ? columns : columns + 1;
  std::vector<Triangle> triangles;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int next = closed ? (i + 1) % columns : i + 1;
      const int a = j * stride + i;
      const int b = j * stride + next;
      const int c = (j + 1) * stride + next;
      const int d = (j + 1) * stride + i;
      triangles.push_back({a, b, c});
      triangles.push_back({a, c, d});
    }
  }
  return triangles;
}

}  // namespace

ResponseCurve wall_curve(double stiffness) {
  const auto k = static_cast<float>(stiffness);
  return {{0.0F, 0.005F, 0.02F}, {0.0F, k, k}};
}

ResponseCurve linear_curve(double stiffness) {
  const auto k = static_cast<float>(stiffness);
  return {{0.0F, 0.02F}, {k, k}};
}

ResponseCurve stiffening_curve(double first, double last, int knots, double step) {
  ResponseCurve curve;
  for (int k = 0; k < knots; ++k) {
    curve.knot.push_back(static_cast<float>(k * step));
    curve.slope.push_back(static_cast<float>(first + (last - first) * k / (knots - 1)));
  }
  return curve;
}

NodeResponse wall_response(double stiffness, double lateral_stiffness) {
  NodeResponse response;
  response.status = ResponseStatus::Fitted;
  response.normal = wall_curve(stiffness);
  response.lateral = linear_curve(lateral_stiffness);
  return response;
}

NodeResponse uniform(const Vec3&) {
  return wall_response(170, 100);
}

NodeResponse uneven(const Vec3& x) {
  NodeResponse r;
  r.status = ResponseStatus::Fitted;
  const double s = 1 + 0.6 * std::sin(90 * x[0]) * std::cos(70 * x[1] + x[2]);
  r.normal = stiffening_curve(0, 500 * s, 6, 0.0013);
  r.lateral = stiffening_curve(150 * s, 300 * s, 5, 0.0017);
  return r;
}

Library coupled(Library library) {
  library.kind = ResponseKind::Coupled;
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const Vec3& x = library.positions[v];
    const double s = 1 + 0.3 * std::sin(130 * x[0] + 80 * x[2]) * std::cos(100 * x[1]);
    const auto f = [&](double value) { return static_cast<float>(s * value); };
    library.responses[v].coupling = {
        f(0.25), {{0.0F, 0.001F, 0.003F, 0.006F, 0.0075F}, {0.0F, f(300), f(150), f(80), 0.0F}}};
  }
  return library;
}

Library relaxing(Library library, const std::vector<double>& times, bool alike) {
  library.relaxation_times = times;
  if (!(library.tool_radius > 0)) library.tool_radius = 0.005;
  const double each = 0.5 / static_cast<double>(times.size());
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const Vec3& x = library.positions[v];
    std::vector<float>& fractions = library.responses[v].relaxation;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double phase = 150 * x[0] + 90 * x[1] - 120 * x[2] + static_cast<double>(i);
      fractions.push_back(static_cast<float>(each * (alike ? 1 : 1 + std::sin(phase) / 3)));
    }
  }
  return library;
}

Library leaning(Library library, double most) {
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const Vec3 &x = library.positions[v], &n = library.inward[v];
    const Vec3 any{std::sin(110 * x[1] + 70 * x[2]), std::cos(90 * x[0] - 50 * x[2]),
                   std::sin(80 * x[0] + 60 * x[1] + 1)};
    const Vec3 across = any - dot(any, n) * n;
    for (std::size_t i = 0; i < 3; ++i)
      library.responses[v].lean[i] = static_cast<float>(most / std::sqrt(3.0) * across[i]);
  }
  return library;
}

Library soft_axes(Library library, double most) {
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const Vec3 &x = library.positions[v], &n = library.inward[v];
    const Vec3 any{std::cos(60 * x[1] - 80 * x[2]), std::sin(70 * x[0] + 90 * x[2]),
                   std::cos(50 * x[0] + 100 * x[1])};
    const Vec3 across = any - dot(any, n) * n;
    for (std::size_t i = 0; i < 3; ++i)
      library.responses[v].soft_axis[i] = static_cast<float>(most / std::sqrt(3.0) * across[i]);
  }
  return library;
}

Library sphere(int level, double radius, const Responses& responses) {
  return bumpy_sphere(level, radius, 0, responses);
}

Library bumpy_sphere(int level, double radius, double amplitude, const Responses& responses) {
  Shell shell = icosahedron();
  for (int i = 0; i < level; ++i) shell = subdivide(shell);
  std::vector<Vec3> positions;
  std::vector<Vec3> inward;
  for (const Vec3& u : shell.points) {
    const double bump = std::sin(3 * u[0]) * std::sin(4 * u[1]) * std::sin(5 * u[2]);
    positions.push_back((radius * (1 + amplitude * bump)) * u);
    inward.push_back(-u);
  }
  if (amplitude > 0) inward = mesh_normals(positions, shell.triangles);
  return finish(std::move(positions), std::move(inward), shell.triangles, responses);
}

Library cylinder(int around, int along, double radius, double length, const Responses& responses) {
  std::vector<Vec3> positions;
  std::vector<Vec3> inward;
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const Vec3 out{std::cos(angle), std::sin(angle), 0};
      positions.push_back(radius * out + Vec3{0, 0, length * j / along});
      inward.push_back(-out);
    }
  }
  return finish(std::move(positions), std::move(inward), grid(around, along, true), responses);
}

Library plate(int n, double side, const Responses& responses) {
  std::vector<Vec3> positions;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) positions.push_back({side * i / n, side * j / n, 0});
  }
  std::vector<Vec3> inward(positions.size(), Vec3{0, 0, -1});
  return finish(std::move(positions), std::move(inward), grid(n, n, false), responses);
}

Library plate_of_200(ResponseKind kind) {
  Library library = plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); });
  if (kind == ResponseKind::Coupled) library = coupled(std::move(library));
  Certificate& c = library.certificate;
  c.friction = 0.3;
  c.stick = 170;
  c.slip = c.lipschitz_bound = 200;
  c.min_lipschitz_bound = 180;
  c.triangles.resize(library.triangles.size());
  return library;
}

Library thin_body(int n, double side, double thickness, const Responses& responses) {
  Library top = plate(n, side, responses);
  const auto shift = static_cast<std::int32_t>(top.positions.size());
  const std::vector<Triangle> upper = top.triangles;
  for (std::size_t v = 0; v < static_cast<std::size_t>(shift); ++v) {
    top.positions.push_back(top.positions[v] - Vec3{0, 0, thickness});
    top.inward.push_back({0, 0, 1});
    top.responses.push_back(top.responses[v]);
  }
  for (const auto& [a, b, c] : upper) top.triangles.push_back({a + shift, c + shift, b + shift});
  return top;
}

Library cube(int n, double side, const Responses& responses) {
  std::map<std::array<int, 3>, std::int32_t> number;  // one vertex for all its faces
  std::vector<Vec3> positions;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [it, is_new] = number.emplace(at, static_cast<std::int32_t>(positions.size()));
    if (is_new) positions.push_back({side * at[0] / n, side * at[1] / n, side * at[2] / n});
    return it->second;
  };
  std::vector<Triangle> triangles;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int level : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int a, int b) {
            std::array<int, 3> at{};
            at[axis] = level;
            at[(axis + 1) % 3] = a;
            at[(axis + 2) % 3] = b;
            return vertex(at);
          };
          std::array<std::int32_t, 4> q{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                        corner(i, j + 1)};
          if (level == 0) std::swap(q[1], q[3]);
          triangles.push_back({q[0], q[1], q[2]});
          triangles.push_back({q[0], q[2], q[3]});
        }
      }
    }
  }
  std::vector<Vec3> inward(positions.size(), Vec3{});
  for (const auto& [at, v] : number) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (at[axis] == 0) inward[static_cast<std::size_t>(v)][axis] += 1;
      if (at[axis] == n) inward[static_cast<std::size_t>(v)][axis] -= 1;
    }
  }
  for (Vec3& u : inward) u = unit(u);
  return finish(std::move(positions), std::move(inward), std::move(triangles), responses);
}

}  // namespace palpate::test
