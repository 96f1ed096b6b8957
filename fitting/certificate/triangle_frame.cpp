// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/triangle_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "format/error.hpp"

namespace palpate::fitting {
namespace {

using Corners = std::array<Vec3, 3>;

[[noreturn]] void refuse_triangle(std::size_t index, const Corners& x, const std::string& problem) {
  const Vec3 centre = (1.0 / 3) * (x[0] + x[1] + x[2]);
  std::array<char, 128> where{};
  std::snprintf(where.data(), where.size(), "response triangle %zu near (%.6g, %.6g, %.6g) m",
                index, centre[0], centre[1], centre[2]);
  throw Error(ErrorKind::Geometry, where.data(), problem,
              "mesh with smaller response triangles there, or smooth the surface");
}

double distance_to_segment(const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double length2 = dot(edge, edge);
  const double t = length2 > 0 ? std::clamp(-dot(a, edge) / length2, 0.0, 1.0) : 0.0;
  return norm(a + t * edge);
}

/// Distance of the origin from the triangle with these corners.
double distance_to_triangle(const Corners& u) {
  double least = std::min({distance_to_segment(u[0], u[1]), distance_to_segment(u[1], u[2]),
                           distance_to_segment(u[2], u[0])});
  const Vec3 normal = cross(u[1] - u[0], u[2] - u[0]);
  const double length = norm(normal);
  if (length < 1e-12) return least;  // nearly a point or a line: the edges determine it
  // The foot of the perpendicular counts if it lies inside, on the same side of all edges.
  const Vec3 foot = (dot(u[0], normal) / (length * length)) * normal;
  for (std::size_t l = 0; l < 3; ++l) {
    const Vec3 edge = u[(l + 1) % 3] - u[l];
    if (dot(cross(edge, foot - u[l]), normal) < 0) return least;
  }
  return std::min(least, norm(foot));
}

/// sup over unit tau in the plane of |M tau| and of |(N x tau) . M tau|, M = sum u_l grad n_l^T.
struct Turning {
  double rate = 0;
  double across = 0;
};

Turning turning(const Corners& u, const Corners& gradient, const Vec3& N) {
  const Vec3 e1 = (1 / norm(gradient[0])) * gradient[0];
  const Vec3 e2 = cross(N, e1);
  const auto column = [&](const Vec3& e) {
    // The gradients sum to zero, so subtracting u_0 makes equal directions give exactly 0.
    return dot(gradient[1], e) * (u[1] - u[0]) + dot(gradient[2], e) * (u[2] - u[0]);
  };
  const Vec3 m1 = column(e1);
  const Vec3 m2 = column(e2);
  const double a = dot(m1, m1);
  const double b = dot(m1, m2);
  const double d = dot(m2, m2);
  Turning result;
  result.rate = std::sqrt(0.5 * (a + d) + std::hypot(0.5 * (a - d), b));
  const double b11 = dot(e1, m1);
  const double b12 = dot(e1, m2);
  const double b21 = dot(e2, m1);
  const double b22 = dot(e2, m2);
  result.across = 0.5 * std::abs(b21 - b12) + 0.5 * std::hypot(b21 + b12, b22 - b11);
  return result;
}

Corners corners_of(const std::vector<Vec3>& values, const Triangle& triangle) {
  return {values[static_cast<std::size_t>(triangle[0])],
          values[static_cast<std::size_t>(triangle[1])],
          values[static_cast<std::size_t>(triangle[2])]};
}

}  // namespace

TriangleFrame triangle_frame(const Library& library, std::size_t index) {
  const Corners x = corners_of(library.positions, library.triangles[index]);
  const Corners u = corners_of(library.inward, library.triangles[index]);
  const Vec3 outward = cross(x[1] - x[0], x[2] - x[0]);
  const double twice_area = norm(outward);
  if (!(twice_area > 0)) refuse_triangle(index, x, "the triangle has no area");
  const Vec3 N = (-1 / twice_area) * outward;

  TriangleFrame frame;
  frame.normal = N;
  frame.inward = u;
  for (std::size_t l = 0; l < 3; ++l) {
    // Perpendicular to the opposite edge, towards vertex l, of length one over the height.
    frame.gradient[l] = (1 / twice_area) * cross(x[(l + 2) % 3] - x[(l + 1) % 3], N);
    if (dot(frame.gradient[l], x[l] - x[(l + 1) % 3]) < 0) {
      frame.gradient[l] = -frame.gradient[l];
    }
    if (!(dot(u[l], N) > 0)) {
      refuse_triangle(index, x,
                      "the press direction of vertex " +
                          std::to_string(library.triangles[index][l]) +
                          " does not point into the facet");
    }
  }
  frame.least_length = distance_to_triangle(u);
  if (frame.least_length < 0.5) {
    refuse_triangle(index, x,
                    "the press directions of its vertices differ too much to be interpolated");
  }
  frame.cos_theta = std::min(1.0, std::min({dot(u[0], N), dot(u[1], N), dot(u[2], N)}));
  double sine = 0;
  for (const Vec3& direction : u) sine = std::max(sine, norm(cross(direction, N)));
  frame.sin_theta = std::min(1.0, sine);

  const Turning turn = turning(u, frame.gradient, N);
  frame.kappa = turn.rate / frame.least_length;
  // The slide frame (n, t, s) is tilted against the facet frame by at most theta.
  const double tilt = std::sqrt(2 * (1 - frame.cos_theta));  // 2 sin(theta/2)
  frame.twist = std::min(frame.kappa, turn.across / frame.least_length + tilt * frame.kappa);
  return frame;
}

}  // namespace palpate::fitting
