// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fidelity/hold_out.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "format/error.hpp"

namespace palpate::fidelity {
namespace {

const Vec3& at_vertex(const std::vector<Vec3>& values, std::int32_t vertex) {
  return values[static_cast<std::size_t>(vertex)];
}

double area(const Library& library, const Triangle& t) {
  const Vec3& a = at_vertex(library.positions, t[0]);
  return 0.5 * norm(cross(at_vertex(library.positions, t[1]) - a,
                          at_vertex(library.positions, t[2]) - a));
}

bool has_responses(const Library& library, const Triangle& triangle) {
  return std::none_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
    return library.responses[static_cast<std::size_t>(v)].status == ResponseStatus::Hole;
  });
}

bool is_computed(const Library& library, std::int32_t vertex) {
  return library.responses[static_cast<std::size_t>(vertex)].status == ResponseStatus::Fitted;
}

HoldOutPoint point_of(const Library& library, std::size_t triangle, const Vec3& natural) {
  const Triangle& t = library.triangles[triangle];
  HoldOutPoint point{static_cast<std::int32_t>(triangle), natural, {}, {}, false, 0};
  for (std::size_t l = 0; l < 3; ++l) {
    point.position = point.position + natural[l] * at_vertex(library.positions, t[l]);
    point.inward = point.inward + natural[l] * at_vertex(library.inward, t[l]);
  }
  point.inward = (1 / norm(point.inward)) * point.inward;
  return point;
}

/// The distributions of <random> differ between standard libraries, so they are not used.
double unit_interval(std::mt19937& engine) {
  return (static_cast<double>(engine()) + 0.5) / 4294967296.0;
}

/// Uniform over the triangle [Turk 1990].
Vec3 even_natural(std::mt19937& engine) {
  const double root = std::sqrt(unit_interval(engine));
  const double t = unit_interval(engine);
  return {1 - root, root * (1 - t), root * t};
}

}  // namespace

std::vector<HoldOutPoint> draw_points(const Library& library, int off_node, int at_node,
                                      std::uint32_t seed) {
  std::vector<std::size_t> usable;
  std::vector<double> sum;  // cumulative areas
  for (std::size_t m = 0; m < library.triangles.size(); ++m) {
    if (!has_responses(library, library.triangles[m])) continue;
    usable.push_back(m);
    sum.push_back((sum.empty() ? 0 : sum.back()) + area(library, library.triangles[m]));
  }
  if (usable.empty()) {
    throw Error(ErrorKind::Configuration, "library '" + library.name + "'",
                "every triangle touches a hole", "fill the holes or compute more sites");
  }
  std::mt19937 engine(seed);
  std::vector<HoldOutPoint> points;
  for (int i = 0; i < off_node; ++i) {
    const auto chosen =
        std::lower_bound(sum.begin(), sum.end(), unit_interval(engine) * sum.back());
    points.push_back(point_of(library, usable[static_cast<std::size_t>(chosen - sum.begin())],
                              even_natural(engine)));
  }
  std::set<std::int32_t> taken;
  for (int tries = 0; tries < 100 * at_node && static_cast<int>(taken.size()) < at_node; ++tries) {
    const std::size_t m = usable[engine() % usable.size()];
    const std::size_t corner = engine() % 3;
    const std::int32_t vertex = library.triangles[m][corner];
    if (!is_computed(library, vertex) || !taken.insert(vertex).second) continue;
    Vec3 natural{};
    natural[corner] = 1;
    points.push_back(point_of(library, m, natural));
    points.back().node = true;
  }
  return points;
}

}  // namespace palpate::fidelity
