// SPDX-License-Identifier: AGPL-3.0-or-later
// Small response libraries with known geometry, for the tests of the certificate.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "format/library.hpp"

namespace palpate::fitting {

inline Vec3 unit(const Vec3& v) {
  return (1 / norm(v)) * v;
}

inline ResponseCurve linear_curve(double slope, double depth = 0.01) {
  return {{0.0f, static_cast<float>(depth)},
          {static_cast<float>(slope), static_cast<float>(slope)}};
}

inline NodeResponse node_response(ResponseCurve normal, ResponseCurve lateral) {
  NodeResponse node;
  node.status = ResponseStatus::Fitted;
  node.normal = std::move(normal);
  node.lateral = std::move(lateral);
  return node;
}

/// One triangle in the plane z = 0, outward up, 10 mm wide.
inline Library flat_triangle() {
  Library library;
  library.name = "flat";
  library.positions = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}};
  library.inward.assign(3, Vec3{0, 0, -1});
  library.triangles = {{0, 1, 2}};
  return library;
}

/// Icosphere with radial press directions; 20 * 4^level triangles.
inline Library sphere(double radius, int level) {
  Library library;
  library.name = "sphere";
  const double a = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Vec3> x{{-1, a, 0},  {1, a, 0},  {-1, -a, 0}, {1, -a, 0}, {0, -1, a},  {0, 1, a},
                      {0, -1, -a}, {0, 1, -a}, {a, 0, -1},  {a, 0, 1},  {-a, 0, -1}, {-a, 0, 1}};
  std::vector<Triangle> triangles{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                  {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                  {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                  {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int i = 0; i < level; ++i) {
    std::vector<Triangle> finer;
    const auto middle = [&](std::int32_t p, std::int32_t q) {
      const Vec3 m = unit(x[static_cast<std::size_t>(p)]) + unit(x[static_cast<std::size_t>(q)]);
      for (std::size_t v = 0; v < x.size(); ++v) {
        if (norm(unit(x[v]) - unit(m)) < 1e-9) return static_cast<std::int32_t>(v);
      }
      x.push_back(m);
      return static_cast<std::int32_t>(x.size() - 1);
    };
    for (const auto& [p, q, r] : triangles) {
      const std::int32_t pq = middle(p, q), qr = middle(q, r), rp = middle(r, p);
      finer.insert(finer.end(), {{p, pq, rp}, {q, qr, pq}, {r, rp, qr}, {pq, qr, rp}});
    }
    triangles = finer;
  }
  library.triangles = triangles;
  for (const Vec3& v : x) {
    library.positions.push_back(radius * unit(v));
    library.inward.push_back(-1.0 * unit(v));
  }
  return library;
}

inline void set_equal_responses(Library& library, const NodeResponse& node) {
  library.responses.assign(library.positions.size(), node);
}

/// A stiffening normal and a lateral curve of random stiffness around 150 and 100 N/m.
inline NodeResponse random_response(std::mt19937& engine, double spread) {
  std::uniform_real_distribution<double> factor(1 - spread, 1 + spread);
  const double k = 150 * factor(engine);
  const double r = 100 * factor(engine);
  const auto f = [](double value) { return static_cast<float>(value); };
  return node_response({{0.0f, 0.002f, 0.005f, 0.008f}, {0.0f, f(0.5 * k), f(0.8 * k), f(k)}},
                       {{0.0f, 0.002f, 0.004f}, {f(0.8 * r), f(r), f(0.9 * r)}});
}

}  // namespace palpate::fitting
