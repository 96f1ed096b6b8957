// SPDX-License-Identifier: Apache-2.0
#include "runtime/collision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "runtime/local_model.hpp"
#include "runtime/sliding.hpp"

namespace palpate::runtime {
namespace {

constexpr std::int32_t kLeafSize = 4;
constexpr std::size_t kDeepest = 64;  // halving 2^31 triangles needs 31 levels
constexpr double kLeastGain = 0.7;  // a pass that leaves more of the lateral deflection overshoots
constexpr double kLeastFraction = 1.0 / 16;
constexpr double kNaturalTolerance = 1e-9;  // neighbours overlap by this much: no gap between them

/// Does the segment meet the box? Slab by slab; a direction component of zero is a containment
/// test.
bool meets(const Vec3& low, const Vec3& high, const Vec3& from, const Vec3& step) noexcept {
  double enter = 0;
  double leave = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    if (step[i] == 0) {
      if (from[i] < low[i] || from[i] > high[i]) return false;
      continue;
    }
    const double a = (low[i] - from[i]) / step[i];
    const double b = (high[i] - from[i]) / step[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

/// Squared distance of x to a box.
double box_distance2(const Vec3& low, const Vec3& high, const Vec3& x) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = std::max({low[i] - x[i], x[i] - high[i], 0.0});
    sum += d * d;
  }
  return sum;
}

/// Natural coordinates of the point of an element that is closest to x: the foot of x where that
/// lies inside, else the best of the three edges.
Vec3 closest_natural(const Surface& surface, const Element& e, const Vec3& x) noexcept {
  Vec3 natural;
  for (std::size_t l = 0; l < 3; ++l) {
    natural[l] = 1.0 + dot(e.gradient[l], x - surface.vertex(e, l));
  }
  if (std::min({natural[0], natural[1], natural[2]}) >= 0) return natural;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t l = 0; l < 3; ++l) {
    const std::size_t a = (l + 1) % 3;
    const std::size_t b = (l + 2) % 3;
    const Vec3 edge = surface.vertex(e, b) - surface.vertex(e, a);
    const Vec3 r = x - surface.vertex(e, a);
    const double s = std::clamp(dot(r, edge) / dot(edge, edge), 0.0, 1.0);
    const Vec3 away = r - s * edge;
    if (dot(away, away) >= best) continue;
    best = dot(away, away);
    natural = {0, 0, 0};
    natural[a] = 1 - s;
    natural[b] = s;
  }
  return natural;
}

struct Entry {
  double at = 2;  ///< position on the segment, 0 .. 1
  SurfacePoint point;
};

void test_entry(const Surface& surface, std::int32_t m, const Vec3& from, const Vec3& to,
                Entry& best) noexcept {
  const Element& e = surface.element(m);
  const double before = surface.outside_distance(e, from);
  const double after = surface.outside_distance(e, to);
  if (!(before >= 0 && after < 0)) return;
  const double at = before / (before - after);
  if (at >= best.at) return;
  const Vec3 p = from + at * (to - from);
  Vec3 natural;
  for (std::size_t l = 0; l < 3; ++l) {
    natural[l] = 1.0 + dot(e.gradient[l], p - surface.vertex(e, l));
    if (!(natural[l] >= -kNaturalTolerance)) return;
    natural[l] = std::max(natural[l], 0.0);
  }
  best.at = at;
  best.point = {m, (1.0 / (natural[0] + natural[1] + natural[2])) * natural};
}

struct Closest {
  double distance2 = 0;  ///< m^2; farther points are ignored
  SurfacePoint point;
};

void test_distance(const Surface& surface, std::int32_t m, const Vec3& x, Closest& best) noexcept {
  const SurfacePoint p{m, closest_natural(surface, surface.element(m), x)};
  const Vec3 r = x - surface.position(p);
  if (dot(r, r) > best.distance2) return;
  best = {dot(r, r), p};
}

/// Is every point of the element farther than the best? Cheap and conservative.
bool surely_further(const Surface& surface, const Element& e, const Vec3& x,
                    const Closest& best) noexcept {
  const double off_plane = surface.outside_distance(e, x);
  return off_plane * off_plane > best.distance2;
}

}  // namespace

SurfacePoint first_entry(const Surface& surface, std::span<const std::int32_t> elements,
                         const Vec3& from, const Vec3& to) noexcept {
  Entry best;
  for (const std::int32_t m : elements) test_entry(surface, m, from, to, best);
  return best.point;
}

SurfacePoint nearest(const Surface& surface, std::span<const std::int32_t> elements, const Vec3& x,
                     double within) noexcept {
  Closest best{within * within, {}};
  for (const std::int32_t m : elements) {
    if (!surely_further(surface, surface.element(m), x, best)) test_distance(surface, m, x, best);
  }
  return best.point;
}

CollisionTree::CollisionTree(const Surface& surface)
    : surface_(&surface), margin_(1e-9 * surface.diagonal()) {
  for (std::int32_t m = 0; m < surface.element_count(); ++m) {
    if (surface.element(m).active) order_.push_back(m);
  }
  nodes_.reserve(2 * order_.size());
  build(0, static_cast<std::int32_t>(order_.size()));
}

CollisionTree::Box CollisionTree::box_of(std::int32_t begin, std::int32_t end) const {
  Box box;
  box.low = box.high =
      surface_->vertex(surface_->element(order_[static_cast<std::size_t>(begin)]), 0);
  for (std::int32_t k = begin; k < end; ++k) {
    const Element& e = surface_->element(order_[static_cast<std::size_t>(k)]);
    for (std::size_t l = 0; l < 3; ++l) {
      for (std::size_t i = 0; i < 3; ++i) {
        box.low[i] = std::min(box.low[i], surface_->vertex(e, l)[i] - margin_);
        box.high[i] = std::max(box.high[i], surface_->vertex(e, l)[i] + margin_);
      }
    }
  }
  return box;
}

void CollisionTree::build(std::int32_t begin, std::int32_t end) {
  const std::size_t here = nodes_.size();
  nodes_.push_back({box_of(begin, end), begin, end - begin});
  if (end - begin <= kLeafSize) return;
  const Vec3 size = nodes_[here].box.high - nodes_[here].box.low;
  const auto axis =
      static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
  const auto centre = [&](std::int32_t m) {
    const Element& e = surface_->element(m);
    return surface_->vertex(e, 0)[axis] + surface_->vertex(e, 1)[axis] +
           surface_->vertex(e, 2)[axis];
  };
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::int32_t a, std::int32_t b) { return centre(a) < centre(b); });
  build(begin, middle);
  nodes_[here].first = static_cast<std::int32_t>(nodes_.size());
  nodes_[here].count = 0;
  build(middle, end);
}

SurfacePoint CollisionTree::first_entry(const Vec3& from, const Vec3& to) const noexcept {
  const Vec3 step = to - from;
  Entry best;
  std::array<std::int32_t, kDeepest> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::int32_t index = stack[--size];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!meets(node.box.low, node.box.high, from, step)) continue;
    if (node.count == 0) {
      stack[size++] = node.first;
      stack[size++] = index + 1;
      continue;
    }
    for (std::int32_t k = node.first; k < node.first + node.count; ++k) {
      test_entry(*surface_, order_[static_cast<std::size_t>(k)], from, to, best);
    }
  }
  return best.point;
}

SurfacePoint CollisionTree::nearest(const Vec3& x, double within) const noexcept {
  Closest best{within * within, {}};
  std::array<std::int32_t, kDeepest> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  const auto distance2 = [&](std::int32_t index) {
    const Box& box = nodes_[static_cast<std::size_t>(index)].box;
    return box_distance2(box.low, box.high, x);
  };
  while (size > 0) {
    const std::int32_t index = stack[--size];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (distance2(index) > best.distance2) continue;
    if (node.count == 0) {
      const bool second_nearer = distance2(node.first) < distance2(index + 1);
      stack[size++] = second_nearer ? index + 1 : node.first;
      stack[size++] = second_nearer ? node.first : index + 1;
      continue;
    }
    for (std::int32_t k = node.first; k < node.first + node.count; ++k) {
      test_distance(*surface_, order_[static_cast<std::size_t>(k)], x, best);
    }
  }
  return best.point;
}

void CollisionTree::gather(const Vec3& from, const Vec3& to, double radius, std::size_t most,
                           std::vector<std::int32_t>& elements) const {
  const Vec3 wide{radius, radius, radius};
  std::array<std::int32_t, kDeepest> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0 && elements.size() < most) {
    const std::int32_t index = stack[--size];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!meets(node.box.low - wide, node.box.high + wide, from, to - from)) continue;
    if (node.count == 0) {
      stack[size++] = node.first;
      stack[size++] = index + 1;
      continue;
    }
    for (std::int32_t k = node.first; k < node.first + node.count; ++k) {
      elements.push_back(order_[static_cast<std::size_t>(k)]);
    }
  }
}

Projection project(const Surface& surface, const SurfacePoint& from, const Vec3& x, int passes,
                   double tolerance, const Delivery* delivered) noexcept {
  Projection p{from, std::numeric_limits<double>::infinity(), false, false};
  double fraction = 1;  // of the lateral deflection walked in a pass; less where passes overshoot
  for (int pass = 0;; ++pass) {
    const Vec3 r = x - surface.position(p.point), n = surface.normal(p.point);
    const Vec3 lateral = r - dot(n, r) * n;
    const double distance = norm(lateral);
    if (distance > kLeastGain * p.lateral) fraction = std::max(fraction / 2, kLeastFraction);
    p.lateral = distance;
    if (distance <= tolerance || pass == passes) return p;
    const Walk moved =
        walk(surface, p.point, (1.0 / distance) * lateral, fraction * distance, delivered);
    p.point = moved.point;
    p.at_border = moved.at_border;
    p.awaiting = moved.awaiting;
  }
}

}  // namespace palpate::runtime
