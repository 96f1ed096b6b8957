// SPDX-License-Identifier: Apache-2.0
#include "runtime/collision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "runtime/local_model.hpp"
#include "runtime/sliding.hpp"

namespace palpate::runtime {
namespace {

constexpr std::int32_t kLeafSize = 4;
constexpr std::size_t kDeepest = 64;        // halving 2^31 triangles needs 31 levels
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

}  // namespace

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
      test_triangle(order_[static_cast<std::size_t>(k)], from, to, best);
    }
  }
  return best.point;
}

void CollisionTree::test_triangle(std::int32_t m, const Vec3& from, const Vec3& to,
                                  Entry& best) const noexcept {
  const Element& e = surface_->element(m);
  const double before = surface_->outside_distance(e, from);
  const double after = surface_->outside_distance(e, to);
  if (!(before >= 0 && after < 0)) return;
  const double at = before / (before - after);
  if (at >= best.at) return;
  const Vec3 p = from + at * (to - from);
  Vec3 natural;
  for (std::size_t l = 0; l < 3; ++l) {
    natural[l] = 1.0 + dot(e.gradient[l], p - surface_->vertex(e, l));
    if (!(natural[l] >= -kNaturalTolerance)) return;
    natural[l] = std::max(natural[l], 0.0);
  }
  best.at = at;
  best.point = {m, (1.0 / (natural[0] + natural[1] + natural[2])) * natural};
}

Projection project(const Surface& surface, const SurfacePoint& from, const Vec3& x, int passes,
                   double tolerance) noexcept {
  Projection p{from, 0, false};
  for (int pass = 0;; ++pass) {
    const Deflection d = LocalModel(surface, p.point, 0).deflection(x);
    p.lateral = d.lateral;
    if (d.lateral <= tolerance || pass == passes) return p;
    const Walk moved = walk(surface, p.point, d.tangent, d.lateral);
    p.point = moved.point;
    p.at_border = moved.at_border;
  }
}

}  // namespace palpate::runtime
