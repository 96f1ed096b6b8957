// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/label_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mesher/volume/samples.hpp"

namespace palpate::mesher {
namespace {

constexpr int kHalvings = 30;

class LabelOracle final : public Oracle {
 public:
  explicit LabelOracle(const LabelField& field) : field_(field) { scan(); }

  std::int32_t region(const Vec3& x) const override {
    for (std::size_t k = 0; k < 3; ++k)
      if (!(x[k] >= field_.box.low[k] && x[k] <= field_.box.high[k])) return kVoid;
    return field_.region(x);
  }

  std::optional<Crossing> crossing(const Vec3& from, const Vec3& to) const override {
    const double length = norm(to - from);
    const auto steps = static_cast<std::int64_t>(std::ceil(2 * length / field_.resolution));
    const std::int32_t first = region(from);
    Vec3 last = from;
    for (std::int64_t i = 1; i <= steps; ++i) {
      const double way = static_cast<double>(i) / static_cast<double>(steps);
      const Vec3 here = from + way * (to - from);
      if (region(here) != first) return between(last, here, first);
      last = here;
    }
    return std::nullopt;
  }

  std::vector<Crossing> seeds(const SizeField& spacing) const override {
    std::vector<Vec3> points;
    for (const Crossing& crossing : interface_) points.push_back(crossing.point);
    std::vector<Crossing> kept;
    for (const std::size_t i : thinned(points, spacing)) kept.push_back(interface_[i]);
    return kept;
  }

  double distance(const Vec3& x) const override {
    double nearest = std::numeric_limits<double>::infinity();
    const double reach = norm(field_.box.high - field_.box.low);
    for (int n = 0; n < 27; ++n) {
      const Vec3 direction = towards_neighbour(n);
      if (n == 13) continue;  // no direction
      const double way = std::min(reach, nearest);
      const auto met = crossing(x, x + (way / norm(direction)) * direction);
      if (met) nearest = std::min(nearest, norm(met->point - x));
    }
    return nearest;
  }

  Bounds box() const override { return field_.box; }
  double volume() const override { return volume_; }
  bool has_one_region() const override { return has_one_region_; }

 private:
  Crossing between(Vec3 from, Vec3 to, std::int32_t first) const {
    std::int32_t beyond = region(to);
    for (int halving = 0; halving < kHalvings; ++halving) {
      const Vec3 middle = 0.5 * (from + to);
      const std::int32_t here = region(middle);
      (here == first ? from : to) = middle;
      if (here != first) beyond = here;
    }
    return {0.5 * (from + to), std::min(first, beyond), std::max(first, beyond)};
  }

  /// Looks at the middles of all voxels: their volume, and the interfaces between neighbours.
  void scan() {
    const double edge = field_.resolution;
    std::array<int, 3> count{};
    for (std::size_t k = 0; k < 3; ++k)
      count[k] = static_cast<int>(std::ceil((field_.box.high[k] - field_.box.low[k]) / edge)) + 1;
    std::int32_t only = kVoid;
    for (int i = -1; i < count[0]; ++i) {
      for (int j = -1; j < count[1]; ++j) {
        for (int k = -1; k < count[2]; ++k) {
          const Vec3 x = field_.box.low + edge * Vec3{i + 0.5, j + 0.5, k + 0.5};
          const std::int32_t here = region(x);
          if (here != kVoid) volume_ += edge * edge * edge;
          if (here != kVoid && only != kVoid && here != only) has_one_region_ = false;
          if (here != kVoid) only = here;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            Vec3 next = x;
            next[axis] += edge;
            if (region(next) != here) interface_.push_back(between(x, next, here));
          }
        }
      }
    }
  }

  LabelField field_;
  std::vector<Crossing> interface_;
  double volume_ = 0;
  bool has_one_region_ = true;
};

}  // namespace

std::unique_ptr<Oracle> make_oracle(const LabelField& field) {
  return std::make_unique<LabelOracle>(field);
}

}  // namespace palpate::mesher
