// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/response.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "format/origin_distance.hpp"

namespace palpate::mesher {
namespace {

// Wanted with a margin over the runtime's 0 and 0.5, so that rounding cannot undo them.
constexpr double kLeastCosine = 0.1;     // of u_l with the inward facet normal
constexpr double kLeastMeanNorm = 0.55;  // |sum n_l u_l|
constexpr int kMaxSweeps = 500;

bool holds(const PlaneSupport& plane, const Vec3& x, double tolerance) {
  return dot(x - plane.point, unit(plane.normal)) >= -tolerance;
}

bool holds(const BoxSupport& box, const Vec3& x, double tolerance) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (x[k] < box.low[k] - tolerance || x[k] > box.high[k] + tolerance) return false;
  }
  return true;
}

bool holds(const SphereSupport& sphere, const Vec3& x, double tolerance) {
  return norm(x - sphere.centre) <= sphere.radius + tolerance;
}

/// That takes the surface itself: see is_near.
bool holds(const SurfaceSupport&, const Vec3&, double) {
  return false;
}

/// That takes the faces of the file.
bool holds(const LabelSupport&, const Vec3&, double) {
  return false;
}

double angle_at(const Vec3& apex, const Vec3& b, const Vec3& c) {
  return std::atan2(norm(cross(b - apex, c - apex)), dot(b - apex, c - apex));
}

/// Outward normals weighted by the angle of each facet at the vertex [Thuermer & Wuthrich 1998].
std::vector<Vec3> mean_inward(const Surface& boundary, std::size_t vertices,
                              const std::vector<std::uint8_t>& held) {
  std::vector<Vec3> touchable(vertices), any(vertices);
  for (const Triangle& t : boundary.triangles) {
    const Vec3 normal = unit(area_vector(boundary.points, t));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(t[k]);
      if (v >= vertices) continue;
      const auto at = [&](std::size_t i) {
        return boundary.points[static_cast<std::size_t>(t[i])];
      };
      const Vec3 share = angle_at(at(k), at((k + 1) % 3), at((k + 2) % 3)) * normal;
      any[v] = any[v] - share;
      if (!all_held(t, held)) touchable[v] = touchable[v] - share;
    }
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    const Vec3 mean = norm(touchable[v]) > 1e-6 ? touchable[v] : any[v];
    // A vertex whose normals cancel has no direction of its own; the sweeps below find one.
    touchable[v] = norm(mean) > 1e-6 ? unit(mean) : Vec3{0, 0, 1};
  }
  return touchable;
}

/// The triangles between which a tool may slide, with their unit inward normals.
struct OpenTriangles {
  std::vector<Triangle> triangles;
  std::vector<Vec3> inward_normal;
};

OpenTriangles open_triangles(const Surface& response, const std::vector<std::uint8_t>& held) {
  OpenTriangles open;
  for (const Triangle& t : response.triangles) {
    if (all_held(t, held)) continue;
    open.triangles.push_back(t);
    open.inward_normal.push_back(-unit(area_vector(response.points, t)));
  }
  return open;
}

/// One pass over the conditions; each violated one turns its directions a little towards meeting
/// it (the perceptron rule, which converges when a solution exists). Returns the vertices of the
/// triangles found in violation.
std::vector<std::int32_t> sweep(const OpenTriangles& open, std::vector<Vec3>& inward) {
  std::vector<std::int32_t> violating;
  for (std::size_t m = 0; m < open.triangles.size(); ++m) {
    const Vec3& normal = open.inward_normal[m];
    std::array<Vec3*, 3> u{};
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = &inward[static_cast<std::size_t>(open.triangles[m][k])];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double cosine = dot(*u[k], normal);
      if (cosine >= kLeastCosine) continue;
      violating.push_back(open.triangles[m][k]);
      *u[k] = unit(*u[k] + (2 * kLeastCosine - cosine) * normal);
    }
    if (origin_to_triangle(*u[0], *u[1], *u[2]) >= kLeastMeanNorm) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      violating.push_back(open.triangles[m][k]);
      *u[k] = unit(*u[k] + 0.1 * normal);
    }
  }
  std::sort(violating.begin(), violating.end());
  violating.erase(std::unique(violating.begin(), violating.end()), violating.end());
  return violating;
}

}  // namespace

bool all_held(const Triangle& t, const std::vector<std::uint8_t>& held) {
  return std::all_of(t.begin(), t.end(),
                     [&](std::int32_t v) { return held[static_cast<std::size_t>(v)] != 0; });
}

bool is_held(const std::vector<Support>& supports, const Vec3& point, double tolerance) {
  return std::any_of(supports.begin(), supports.end(), [&](const Support& support) {
    return std::visit([&](const auto& shape) { return holds(shape, point, tolerance); }, support);
  });
}

bool is_near(const SurfaceQuery& surface, const Vec3& point, double distance) {
  return norm(surface.closest(point).point - point) <= distance || surface.contains(point);
}

InwardDirections inward_directions(const Surface& response, const Surface& boundary,
                                   const std::vector<std::uint8_t>& held) {
  InwardDirections result;
  result.inward = mean_inward(boundary, response.points.size(), held);
  const std::vector<Vec3> mean = result.inward;
  const OpenTriangles open = open_triangles(response, held);
  for (int i = 0; i < kMaxSweeps; ++i) {
    result.unresolved = sweep(open, result.inward);
    if (result.unresolved.empty()) break;
  }
  for (std::size_t v = 0; v < mean.size(); ++v) {
    const double cosine = dot(mean[v], result.inward[v]);
    if (cosine >= 1 - 1e-12) continue;
    ++result.adjusted;
    const double turn = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (turn <= result.largest_turn) continue;
    result.largest_turn = turn;
    result.turned_most = v;
  }
  return result;
}

}  // namespace palpate::mesher
