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

/// Natural coordinates may leave [0, 1] by rounding only; put them back, summing to 1.
Vec3 tidy(Vec3 natural) noexcept {
  double sum = 0;
  for (double& n : natural) {
    n = std::max(n, 0.0);
    sum += n;
  }
  return (1.0 / sum) * natural;
}

/// One walk in progress.
class Walker {
 public:
  Walker(const Surface& surface, const SurfacePoint& from, const Vec3& direction,
         double distance) noexcept
      : surface_(surface), direction_(direction), remaining_(distance), point_(from) {}

  Walk run() noexcept {
    for (int i = 0; i < kMostEdges && remaining_ > 0; ++i) {
      if (!project()) break;
      const std::size_t exit = advance();
      if (exit == kNone || remaining_ <= 0) break;
      if (!cross(exit) && !follow(exit)) break;
    }
    point_.natural = tidy(point_.natural);
    return {point_, at_border_};
  }

 private:
  const Element& element() const noexcept { return surface_.element(point_.element); }

  /// Unit direction of the walk in the plane of an element; false when it is the normal of the
  /// plane.
  bool project_on(const Element& e, Vec3& in_plane) const noexcept {
    in_plane = direction_ - dot(direction_, e.facet_normal) * e.facet_normal;
    const double length = norm(in_plane);
    if (!(length > kLeastProjection)) return false;
    in_plane = (1.0 / length) * in_plane;
    return true;
  }
  bool project() noexcept { return project_on(element(), in_plane_); }

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

  /// Steps over the edge opposite to vertex `exit` when the direction points into the neighbour.
  bool cross(std::size_t exit) noexcept {
    const std::int32_t next = element().neighbour[exit];
    if (next == kNoElement) {
      at_border_ = true;
      return false;
    }
    const Element& n = surface_.element(next);
    Vec3 d;
    if (!project_on(n, d)) return false;
    const SurfacePoint there = seen_from(next);
    std::size_t apex = 0;
    for (std::size_t l = 0; l < 3; ++l) {
      if (n.neighbour[l] == point_.element && there.natural[l] == 0) apex = l;
    }
    if (!(dot(n.gradient[apex], d) > 0)) return false;
    point_ = there;
    return true;
  }

  /// The point, which lies on a shared edge or vertex, in the coordinates of the other element.
  SurfacePoint seen_from(std::int32_t other) const noexcept {
    SurfacePoint p{other, {}};
    const Element& from = element();
    const Element& to = surface_.element(other);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (from.vertices[i] == to.vertices[j]) p.natural[j] = point_.natural[i];
      }
    }
    return p;
  }

  /// Follows the edge opposite to `exit` by the component of the motion along it. At its end the
  /// walk goes on in the next triangle around that vertex.
  bool follow(std::size_t exit) noexcept {
    const Element& e = element();
    std::size_t from = (exit + 1) % 3;
    std::size_t to = (exit + 2) % 3;
    Vec3 edge = surface_.vertex(e, to) - surface_.vertex(e, from);
    double along = dot(direction_, edge);
    if (along < 0) {
      std::swap(from, to);
      edge = -edge;
      along = -along;
    }
    const double length = norm(edge);
    const double share = along / length;
    if (!(share > kLeastProjection)) return false;
    const double free_length = point_.natural[from] * length;
    const double reach = std::min(remaining_ * share, free_length);
    move((1.0 / length) * edge, reach);
    point_.natural[exit] = 0;
    remaining_ -= reach / share;
    if (reach < free_length) {
      remaining_ = 0;
      return false;
    }
    point_.natural = {0, 0, 0};
    point_.natural[to] = 1;
    return pivot(from);
  }

  /// At a vertex: on into the triangle across the edge opposite to vertex `from`.
  bool pivot(std::size_t from) noexcept {
    const std::int32_t next = element().neighbour[from];
    if (next == kNoElement) {
      at_border_ = true;
      return false;
    }
    point_ = seen_from(next);
    return true;
  }

  const Surface& surface_;
  Vec3 direction_;
  double remaining_;
  SurfacePoint point_;
  Vec3 in_plane_{};
  bool at_border_ = false;
};

}  // namespace

Walk walk(const Surface& surface, const SurfacePoint& from, const Vec3& direction,
          double distance) noexcept {
  return Walker(surface, from, direction, distance).run();
}

}  // namespace palpate::runtime
