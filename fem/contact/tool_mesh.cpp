// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/contact/tool_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "format/edge.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

using Eigen::Vector3d;

/// A surface over rings s = 0, 1, 2 .. and angles phi = 0 .. span. A ring without intervals is a
/// pole.
struct Rings {
  std::vector<int> intervals;                           ///< number of intervals of each ring
  double span;                                          ///< rad; 2 pi where the rings close
  std::function<Vector3d(double s, double phi)> point;  ///< smooth between two rings
  Vector3d inside;  ///< a point from which the whole surface is visible
  /// Projects the middle of a chord onto the surface; empty: the point halfway along s and phi,
  /// which serves where facets span small angles.
  std::function<Vector3d(const Vector3d&)> onto = {};

  bool closed() const { return span > 6; }
};

/// Rings from a pole outwards: `step` more intervals on each, up to `most`.
std::vector<int> growing(int rings, int step, int most) {
  std::vector<int> intervals;
  for (int k = 0; k <= rings; ++k) intervals.push_back(std::min(step * k, most));
  return intervals;
}

Rings sphere_rings(const Tool& tool, int divisions) {
  const double R = tool.geometry.radius;
  const Vector3d centre = tool.tip - R * tool.inward, side = tool.inward.cross(tool.axis);
  const auto point = [=, inward = tool.inward, axis = tool.axis](double s, double phi) -> Vector3d {
    const double theta = 0.5 * M_PI * s / divisions;
    return centre + R * (std::cos(theta) * inward +
                         std::sin(theta) * (std::cos(phi) * axis + std::sin(phi) * side));
  };
  const auto onto = [=](const Vector3d& x) -> Vector3d {
    return centre + R * (x - centre).normalized();
  };
  return {growing(divisions, 6, 6 * divisions), 2 * M_PI, point, centre, onto};
}

Rings disc_rings(const Tool& tool, double side_length, int divisions) {
  const double R = tool.geometry.radius, e = tool.geometry.edge_radius;
  const int flat = e < R ? divisions : 0,
            edge = e > 0 ? std::max(4, static_cast<int>(std::lround(divisions * e / R))) : 0;
  const int side = std::max(2, divisions / 4);
  const Vector3d across = tool.inward.cross(tool.axis);
  const auto point = [=, tip = tool.tip, inward = tool.inward, axis = tool.axis](
                         double s, double phi) -> Vector3d {
    double r = R, height = 0;  // of the profile: end, edge, side
    if (s < flat) {
      r = (R - e) * s / flat;
    } else if (s < flat + edge) {
      const double theta = 0.5 * M_PI * (s - flat) / edge;
      r = R - e + e * std::sin(theta);
      height = e * (1 - std::cos(theta));
    } else {
      height = e + side_length * (s - flat - edge) / side;
    }
    return tip - height * inward + r * (std::cos(phi) * axis + std::sin(phi) * across);
  };
  return {growing(flat + edge + side, 6, 6 * divisions), 2 * M_PI, point,
          tool.tip - (e + side_length) * tool.inward};
}

/// Half a body of revolution about the axis of the cylinder, from one end of it to the other.
Rings cylinder_rings(const Tool& tool, int divisions) {
  const double R = tool.geometry.radius, length = tool.geometry.length;
  const int straight = std::max(1, static_cast<int>(std::lround(length / R * divisions / 1.5)));
  const Vector3d centre = tool.tip - R * tool.inward, across = tool.inward.cross(tool.axis);
  const auto point = [=, inward = tool.inward, axis = tool.axis](double s, double phi) -> Vector3d {
    const double end = std::clamp(s - divisions, 0.0, static_cast<double>(straight));
    const double theta = 0.5 * M_PI * (s - end) / divisions;
    const double along = -R * std::cos(theta) + length * (end / straight - 0.5);
    return centre + along * axis +
           R * std::sin(theta) * (std::cos(phi) * across + std::sin(phi) * inward);
  };
  Rings rings{growing(divisions, 4, 2 * divisions), M_PI, point, centre};
  std::vector<int> back(rings.intervals.rbegin(), rings.intervals.rend());
  rings.intervals.insert(rings.intervals.end(), static_cast<std::size_t>(straight - 1),
                         back.front());
  rings.intervals.insert(rings.intervals.end(), back.begin(), back.end());
  return rings;
}

class Mesher {
 public:
  explicit Mesher(const Rings& rings) : rings_(rings) {
    for (const int n : rings.intervals) {
      first_.push_back(static_cast<std::int32_t>(points_.size()));
      const auto ring = static_cast<int>(first_.size()) - 1;
      for (int i = 0; i < (rings.closed() ? std::max(n, 1) : n + 1); ++i)
        points_.push_back(middle_of({ring, i}, {ring, i}));
    }
    inside_ = add(rings.inside);
  }

  ToolMesh mesh() {
    for (int k = 0; k + 1 < static_cast<int>(rings_.intervals.size()); ++k) between(k);
    ToolMesh mesh{Eigen::Matrix3Xd(3, static_cast<Eigen::Index>(points_.size())),
                  std::move(tetrahedra_)};
    for (std::size_t i = 0; i < points_.size(); ++i)
      mesh.X.col(static_cast<Eigen::Index>(i)) = points_[i];
    return mesh;
  }

 private:
  struct Corner {
    int ring, i;
  };

  int intervals(int ring) const { return rings_.intervals[to_index(ring)]; }
  double phi(const Corner& c) const { return rings_.span * c.i / std::max(intervals(c.ring), 1); }
  std::int32_t node(const Corner& c) const {
    const int n = intervals(c.ring);
    return first_[to_index(c.ring)] + (rings_.closed() && n > 0 ? c.i % n : c.i);
  }
  std::int32_t add(const Vector3d& x) {
    points_.push_back(x);
    return static_cast<std::int32_t>(points_.size()) - 1;
  }

  /// On the surface, halfway between two corners of a facet; a pole has the angle of the other.
  Vector3d middle_of(const Corner& a, const Corner& b) const {
    const double from = intervals(a.ring) > 0 ? phi(a) : phi(b);
    const double to = intervals(b.ring) > 0 ? phi(b) : phi(a);
    return rings_.point(0.5 * (a.ring + b.ring), 0.5 * (from + to));
  }

  std::int32_t middle(std::int32_t a, std::int32_t b, const Vector3d& x) {
    const auto [found, fresh] = middles_.try_emplace(edge_between(a, b), 0);
    if (fresh) found->second = add(x);
    return found->second;
  }

  /// Facets between ring k and the next: the strip advances on the ring whose next corner comes
  /// first.
  void between(int k) {
    const int inner = intervals(k), outer = intervals(k + 1);
    for (Corner a{k, 0}, b{k + 1, 0}; a.i < inner || b.i < outer;) {
      const bool outwards = b.i < outer && (a.i == inner || (b.i + 1) * inner <= (a.i + 1) * outer);
      Corner& next = outwards ? b : a;
      const Corner before = next;
      ++next.i;
      facet({a, b, before});
    }
  }

  void facet(std::array<Corner, 3> c) {
    const auto x = [&](std::size_t i) { return points_[to_index(node(c[i]))]; };
    // Node 3 lies inside, where the corners appear in the opposite order than from outside.
    if ((x(1) - x(0)).cross(x(2) - x(0)).dot(rings_.inside - x(0)) < 0) std::swap(c[1], c[2]);
    Tetrahedron10 tetrahedron{node(c[0]), node(c[1]), node(c[2]), inside_};
    for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
      const auto [i, j] = kTetEdges[e];
      Vector3d half = 0.5 * (x(i) + (j == 3 ? rings_.inside : x(j)));
      if (j < 3) half = rings_.onto ? rings_.onto(half) : middle_of(c[i], c[j]);
      tetrahedron[4 + e] = middle(tetrahedron[i], tetrahedron[j], half);
    }
    tetrahedra_.push_back(tetrahedron);
  }

  const Rings& rings_;
  std::vector<std::int32_t> first_;
  std::int32_t inside_ = 0;
  std::vector<Vector3d> points_;
  std::map<Edge, std::int32_t> middles_;
  std::vector<Tetrahedron10> tetrahedra_;
};

Rings rings_of(const Tool& tool, double side, int divisions) {
  switch (tool.geometry.shape) {
    case ToolShape::Sphere:
      return sphere_rings(tool, divisions);
    case ToolShape::Disc:
      return disc_rings(tool, side, divisions);
    case ToolShape::Cylinder:
      return cylinder_rings(tool, divisions);
  }
  return {};
}

}  // namespace

ToolMesh make_tool_mesh(const Tool& tool, double side, int divisions) {
  const Rings rings = rings_of(tool, side, divisions);
  return Mesher(rings).mesh();
}

}  // namespace palpate::fem
