// SPDX-License-Identifier: Apache-2.0
#include "runtime/search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace palpate::runtime {
namespace {

constexpr double kLooksAhead =
    2;  // searches: the next delivery comes one search later, plus its duration
constexpr std::size_t kMostNear = 8192;  // triangles considered for a free tip

Vec3 centre(const Surface& surface, std::int32_t m) {
  return surface.position({m, {1.0 / 3, 1.0 / 3, 1.0 / 3}});
}

}  // namespace

Search::Search(const Surface& surface, const CollisionTree& tree, std::size_t most)
    : surface_(&surface),
      tree_(&tree),
      most_(std::min(most, Delivery::kMost)),
      stamp_(static_cast<std::size_t>(surface.element_count()), 0) {
  double sum = 0;
  for (std::int32_t m = 0; m < surface.element_count(); ++m) {
    const Element& e = surface.element(m);
    sum += norm(surface.vertex(e, 1) - surface.vertex(e, 0));
  }
  edge_ = sum / surface.element_count();
}

Delivery Search::look(const TipReport& tip) {
  ++look_;
  found_.clear();
  const Vec3 before = last_.value_or(tip.position);
  last_ = tip.position;
  const Vec3 motion = tip.position - before;
  const Way way{tip.position, tip.position + kLooksAhead * motion};
  Delivery delivery;
  if (tip.element != kNoElement) {
    around(tip.element, way);
  } else {
    near(way, norm(motion));
    delivery.entry = tree_->first_entry(before, tip.position);
  }
  delivery.assign(found_);
  return delivery;
}

/// Distance of the centroid of a triangle from the predicted path, m.
double Search::distance(std::int32_t m, const Way& way) const {
  const Vec3 along = way.to - way.from;
  const Vec3 r = centre(*surface_, m) - way.from;
  const double length2 = dot(along, along);
  const double s = length2 > 0 ? std::clamp(dot(r, along) / length2, 0.0, 1.0) : 0.0;
  return norm(r - s * along);
}

bool Search::add(std::int32_t m) {
  std::uint32_t& stamp = stamp_[static_cast<std::size_t>(m)];
  if (stamp == look_) return false;
  stamp = look_;
  found_.push_back(m);
  return true;
}

void Search::around(std::int32_t active, const Way& way) {
  add_ring(active);
  using Candidate = std::pair<double, std::int32_t>;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> open;
  for (const std::int32_t m : found_) open.emplace(distance(m, way), m);
  while (!open.empty() && found_.size() < most_) {
    const std::int32_t m = open.top().second;
    open.pop();
    for (const std::int32_t next : surface_->element(m).neighbour) {
      if (next != kNoElement && found_.size() < most_ && add(next)) {
        open.emplace(distance(next, way), next);
      }
    }
  }
}

/// The active element and every triangle that shares a vertex with it, by walking around its
/// vertices both ways.
void Search::add_ring(std::int32_t active) {
  add(active);
  for (const std::int32_t vertex : surface_->element(active).vertices) {
    for (const std::size_t side : {std::size_t{1}, std::size_t{2}}) {
      std::int32_t m = active;
      do {
        const auto& vertices = surface_->element(m).vertices;
        const auto at = std::find(vertices.begin(), vertices.end(), vertex) - vertices.begin();
        m = surface_->element(m).neighbour[(static_cast<std::size_t>(at) + side) % 3];
        if (m != kNoElement) add(m);
      } while (m != kNoElement && m != active);
    }
  }
}

void Search::near(const Way& way, double motion) {
  std::vector<std::int32_t> all;
  tree_->gather(way.from, way.to, motion + 2 * edge_, kMostNear, all);
  std::vector<std::pair<double, std::int32_t>> ranked;
  for (const std::int32_t m : all) ranked.emplace_back(distance(m, way), m);
  const std::size_t count = std::min(most_, ranked.size());
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count),
                    ranked.end());
  for (std::size_t i = 0; i < count; ++i) found_.push_back(ranked[i].second);
}

}  // namespace palpate::runtime
