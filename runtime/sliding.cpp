// SPDX-License-Identifier: Apache-2.0
#include "runtime/sliding.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpate::runtime {
namespace {

constexpr int kMostEdges = 64;
constexpr double kLeastProjection = 1e-9;  // of a unit vector: below it the direction is the normal
constexpr std::size_t kNone = 3;

/// Natural coordinates may leave [0, 1] by rounding only; put them back, summing to 1. The
/// reciprocal of a sum so near to 1 is 2 - sum, to rounding, and does not wait for a quotient.
Vec3 tidy(Vec3 natural) noexcept {
  for (double& n : natural) n = std::max(n, 0.0);
  return (2.0 - (natural[0] + natural[1] + natural[2])) * natural;
}

/// One walk in progress.
class Walker {
 public:
  Walker(const Surface& surface, const SurfacePoint& from, const Vec3& direction, double distance,
         const Delivery* delivered) noexcept
      : surface_(surface),
        delivered_(delivered),
        direction_(direction),
        length_(norm(direction)),
        remaining_(distance),
        point_(from) {}

  Walk run() noexcept {
    for (int i = 0; i < kMostEdges && remaining_ > 0; ++i) {
      const std::size_t corner = vertex_here();
      if (corner != kNone && !face_direction(corner)) {
        if (!leave_along_edge()) break;
        continue;
      }
      if (!project()) break;
      const std::size_t exit = advance();
      if (exit == kNone) break;
      if (vertex_here() == kNone && !cross(exit) && !follow(exit)) break;
    }
    return {point_, stopped_by_.border, stopped_by_.undelivered, followed_ || remaining_ > 0};
  }

 private:
  /// Why the walk cannot continue.
  struct Obstacle {
    bool border = false, undelivered = false;
    void add(const Obstacle& other) noexcept {
      border = border || other.border;
      undelivered = undelivered || other.undelivered;
    }
  };

  /// The triangle across edge l of m, or kNoElement and the reason.
  std::int32_t across(std::int32_t m, std::size_t l, Obstacle& obstacle) const noexcept {
    const std::int32_t next = surface_.element(m).neighbour[l];
    if (next == kNoElement) {
      obstacle.border = true;
      return next;
    }
    if (delivered_ == nullptr || delivered_->holds(next)) return next;
    obstacle.undelivered = true;
    return kNoElement;
  }

  const Element& element() const noexcept { return surface_.element(point_.element); }

  /// Unit direction of the walk in the plane of an element; false when it is the normal of the
  /// plane.
  bool project_on(const Element& e, Vec3& in_plane) const noexcept {
    in_plane = direction_ - dot(direction_, e.facet_normal) * e.facet_normal;
    const double length = norm(in_plane);
    if (!(length > kLeastProjection * length_)) return false;
    in_plane = (1.0 / length) * in_plane;
    return true;
  }
  /// After crossing into an element.
  bool project() noexcept {
    const bool done = projected_;
    projected_ = false;
    return done || project_on(element(), in_plane_);
  }

  /// Walks to the end of the distance (kNone) or to the edge opposite to the returned vertex.
  std::size_t advance() noexcept {
    const Element& e = element();
    std::size_t exit = kNone;
    double reach = remaining_;
    for (std::size_t l = 0; l < 3; ++l) {
      const double rate = dot(e.gradient[l], in_plane_);
      if (rate < 0 && point_.natural[l] + reach * rate <= 0) {
        reach = std::max(0.0, point_.natural[l] / -rate);
        exit = l;
      }
    }
    move(in_plane_, reach);
    if (exit != kNone) point_.natural[exit] = 0;
    point_.natural = tidy(point_.natural);
    remaining_ -= reach;
    return exit;
  }

  void move(const Vec3& d, double length) noexcept {
    const Element& e = element();
    for (std::size_t l = 0; l < 3; ++l) point_.natural[l] += length * dot(e.gradient[l], d);
  }

  /// Fraction of the motion along an edge, in [0, 1].
  double fraction_along(const Vec3& edge) const noexcept {
    return dot(direction_, edge) / (norm(edge) * length_);
  }

  /// Steps over the edge opposite to vertex `exit` when the direction points into the neighbour.
  bool cross(std::size_t exit) noexcept {
    const std::int32_t next = across(point_.element, exit, stopped_by_);
    if (next == kNoElement) return false;
    const Element& n = surface_.element(next);
    Vec3 d;
    if (!project_on(n, d)) return false;
    const std::size_t a = (exit + 1) % 3;
    const std::size_t b = (exit + 2) % 3;
    const std::size_t apex = vertex_besides(n, element().vertices[a], element().vertices[b]);
    if (!(dot(n.gradient[apex], d) > 0)) return false;
    // Neighbours of one orientation traverse their edge in opposite directions.
    SurfacePoint there{next, {}};
    there.natural[(apex + 1) % 3] = point_.natural[b];
    there.natural[(apex + 2) % 3] = point_.natural[a];
    point_ = there;
    in_plane_ = d;
    projected_ = true;
    return true;
  }

  /// The vertex of an element that is neither of two. Without branches, which could not be
  /// predicted.
  static std::size_t vertex_besides(const Element& e, std::int32_t a, std::int32_t b) noexcept {
    const auto is = [&](std::size_t l) {
      return static_cast<std::size_t>(e.vertices[l] != a) *
             static_cast<std::size_t>(e.vertices[l] != b);
    };
    return is(1) + 2 * is(2);
  }

  /// Follows the edge opposite to `exit` by the component of the motion along it.
  bool follow(std::size_t exit) noexcept {
    const Element& e = element();
    const std::size_t a = (exit + 1) % 3;
    const std::size_t b = (exit + 2) % 3;
    const bool towards_b = dot(direction_, surface_.vertex(e, b) - surface_.vertex(e, a)) > 0;
    return towards_b ? go_along(a, b) : go_along(b, a);
  }

  bool go_along(std::size_t from, std::size_t to) noexcept {
    followed_ = true;
    const Element& e = element();
    const Vec3 edge = surface_.vertex(e, to) - surface_.vertex(e, from);
    const double length = norm(edge);
    const double fraction = fraction_along(edge);
    if (!(fraction > kLeastProjection)) return false;
    const double to_end = point_.natural[from] * length;
    if (remaining_ * fraction < to_end) {
      move((1.0 / length) * edge, remaining_ * fraction);
      point_.natural[3 - from - to] = 0;
      point_.natural = tidy(point_.natural);
      remaining_ = 0;
      return true;
    }
    remaining_ -= to_end / fraction;
    point_.natural = {0, 0, 0};
    point_.natural[to] = 1;
    return true;
  }

  /// The vertex on which the point lies, kNone elsewhere.
  std::size_t vertex_here() const noexcept {
    for (std::size_t l = 0; l < 3; ++l) {
      if (point_.natural[(l + 1) % 3] == 0 && point_.natural[(l + 2) % 3] == 0) return l;
    }
    return kNone;
  }

  /// At a vertex: turns around it to the triangle into which the direction points. When there is
  /// none, remembers the edge that leaves the vertex most nearly in the direction.
  bool face_direction(std::size_t corner) noexcept {
    spoke_ = {};
    const std::int32_t vertex = element().vertices[corner];
    const std::int32_t first = point_.element;
    Obstacle obstacle;
    for (const std::size_t side : {std::size_t{1}, std::size_t{2}}) {
      std::int32_t m = first;
      for (int i = 0; i < kMostEdges; ++i) {
        const std::size_t v = local_index(m, vertex);
        if (examine(m, v)) return true;
        m = across(m, (v + side) % 3, obstacle);
        if (m == kNoElement || m == first) break;
      }
    }
    stopped_by_.add(obstacle);
    return false;
  }

  bool examine(std::int32_t m, std::size_t v) noexcept {
    const Element& e = surface_.element(m);
    const std::size_t a = (v + 1) % 3;
    const std::size_t b = (v + 2) % 3;
    Vec3 d;
    if (project_on(e, d) && dot(e.gradient[a], d) >= 0 && dot(e.gradient[b], d) >= 0) {
      stand_on(m, v);
      return true;
    }
    for (const std::size_t to : {a, b}) {
      const Vec3 edge = surface_.vertex(e, to) - surface_.vertex(e, v);
      const double fraction = fraction_along(edge);
      if (fraction > spoke_.fraction) spoke_ = {m, v, to, fraction};
    }
    return false;
  }

  bool leave_along_edge() noexcept {
    if (!(spoke_.fraction > kLeastProjection)) return false;
    stand_on(spoke_.element, spoke_.from);
    return go_along(spoke_.from, spoke_.to);
  }

  void stand_on(std::int32_t m, std::size_t v) noexcept {
    point_ = {m, {0, 0, 0}};
    point_.natural[v] = 1;
  }

  std::size_t local_index(std::int32_t m, std::int32_t vertex) const noexcept {
    const auto& v = surface_.element(m).vertices;
    return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
  }

  /// An edge that leaves a vertex.
  struct Spoke {
    std::int32_t element = kNoElement;
    std::size_t from = 0, to = 0;
    double fraction = 0;  ///< of the motion along it
  };

  const Surface& surface_;
  const Delivery* delivered_;
  Vec3 direction_;
  double length_;  ///< of the direction
  double remaining_;
  SurfacePoint point_;
  Vec3 in_plane_{};
  bool projected_ = false;  ///< is in_plane_ that of the element?
  Spoke spoke_;
  Obstacle stopped_by_;
  bool followed_ = false;  ///< an edge instead of the direction
};

}  // namespace

Walk walk(const Surface& surface, const SurfacePoint& from, const Vec3& direction, double distance,
          const Delivery* delivered) noexcept {
  return Walker(surface, from, direction, distance, delivered).run();
}

}  // namespace palpate::runtime
