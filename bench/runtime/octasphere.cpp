// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bench/runtime/octasphere.hpp"

#include <array>
#include <cmath>
#include <map>

namespace palpate::bench {
namespace {

ResponseCurve curve(double first, double last) {
  constexpr int kKnots = 8;
  constexpr double kDepth = 0.014;
  ResponseCurve c;
  for (int k = 0; k < kKnots; ++k) {
    const double s = static_cast<double>(k) / (kKnots - 1);
    c.knot.push_back(static_cast<float>(kDepth * s));
    c.slope.push_back(static_cast<float>(first + (last - first) * s));
  }
  return c;
}

NodeResponse response(const Vec3& x) {
  const double k = 200 + 50 * std::sin(100 * x[0]) * std::cos(80 * x[1]) + 50 * std::sin(60 * x[2]);
  NodeResponse r;
  r.status = ResponseStatus::Fitted;
  r.normal = curve(0, k);
  r.lateral = curve(0.6 * k, 0.8 * k);
  r.coupling = {0.3F,
                {{0, 0.0005F, 0.001F, 0.003F, 0.006F}, {0, 300, 250, 150, 90}}};  // if coupled
  return r;
}

/// Numbers the points of the octahedron |i| + |j| + |k| = n; points that faces share are one.
class Vertices {
 public:
  Vertices(int n, Library& library) : n_(n), library_(library) {}
  std::int32_t at(const std::array<int, 3>& point) {
    const auto [it, is_new] =
        number_.emplace(point, static_cast<std::int32_t>(library_.positions.size()));
    if (is_new) add(point);
    return it->second;
  }

 private:
  void add(const std::array<int, 3>& point) {
    const Vec3 flat{static_cast<double>(point[0]) / n_, static_cast<double>(point[1]) / n_,
                    static_cast<double>(point[2]) / n_};
    const Vec3 out = (1.0 / norm(flat)) * flat;
    library_.positions.push_back(kOctasphereRadius * out);
    library_.inward.push_back(-out);
    library_.responses.push_back(response(library_.positions.back()));
  }

  int n_;
  Library& library_;
  std::map<std::array<int, 3>, std::int32_t> number_;
};

}  // namespace

Library octasphere(int n, ResponseKind kind) {
  Library library;
  library.kind = kind;
  library.name = "octasphere";
  Vertices vertices(n, library);
  for (int octant = 0; octant < 8; ++octant) {
    const std::array<int, 3> sign{octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
    const bool mirrored = sign[0] * sign[1] * sign[2] < 0;
    const auto at = [&](int i, int j) {
      return vertices.at({sign[0] * i, sign[1] * j, sign[2] * (n - i - j)});
    };
    const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
      library.triangles.push_back(mirrored ? Triangle{a, c, b} : Triangle{a, b, c});
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        add(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  return library;
}

}  // namespace palpate::bench
