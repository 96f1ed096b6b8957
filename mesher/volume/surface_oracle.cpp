// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/surface_oracle.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/geometry/cgal_mesh.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/volume/samples.hpp"

namespace palpate::mesher {
namespace {

using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

void append_triangles(const Surface& surface, Triangles& triangles) {
  for (const Triangle& t : surface.triangles) {
    const auto corner = [&](std::size_t k) { return to_point(surface.points[to_index(t[k])]); };
    triangles.emplace_back(corner(0), corner(1), corner(2));
  }
}

/// Where the segment meets the plane of the triangle, as a fraction of the segment.
double fraction_at(const Kernel::Triangle_3& triangle, const Vec3& from, const Vec3& to) {
  const Vec3 a = to_vec3(triangle[0]);
  const Vec3 normal = cross(to_vec3(triangle[1]) - a, to_vec3(triangle[2]) - a);
  const double before = dot(normal, from - a), after = dot(normal, to - a);
  if (before == after) return 0.5;  // inside the plane
  return std::clamp(before / (before - after), 0.0, 1.0);
}

Crossing ordered(const Vec3& point, std::int32_t a, std::int32_t b) {
  return {point, std::min(a, b), std::max(a, b)};
}

class SurfaceOracle final : public Oracle {
 public:
  SurfaceOracle(const Domain& domain, double step)
      : domain_(domain), step_(step), skin_(domain_.skin) {
    append_triangles(domain_.skin, triangles_);
    for (const Enclosure& enclosure : domain_.enclosures) {
      append_triangles(enclosure.surface, triangles_);
      inside_.emplace_back(enclosure.surface);
    }
    tree_.insert(triangles_.cbegin(), triangles_.cend());
    tree_.build();
    double depth = 0;
    for (const Layer& layer : domain_.layers) walls_.push_back(depth += layer.thickness);
  }

  std::int32_t region(const Vec3& x) const override {
    const int owner = owner_at(x);
    if (owner == kOutside) return kVoid;
    return owner == kMatrix ? region_at_depth(depth(x))
                            : domain_.enclosures[to_index(owner)].region;
  }

  std::optional<Crossing> crossing(const Vec3& from, const Vec3& to) const override {
    return has_one_surface() ? any_crossing(from, to) : first_crossing(from, to);
  }

  std::vector<Crossing> seeds(const SizeField& spacing) const override {
    std::vector<Crossing> all;
    add_seeds(domain_.skin, spacing, all);
    for (const Enclosure& enclosure : domain_.enclosures)
      add_seeds(enclosure.surface, spacing, all);
    for (const double wall : walls_) add_seeds_of_wall(wall, spacing, all);
    return all;
  }

  Bounds box() const override { return bounds(domain_.skin.points); }

  bool has_one_region() const override {
    return domain_.layers.empty() &&
           std::all_of(domain_.enclosures.begin(), domain_.enclosures.end(),
                       [](const Enclosure& e) { return e.region == kVoid || e.region == 0; });
  }

 private:
  bool has_one_surface() const { return domain_.enclosures.empty() && walls_.empty(); }

  std::optional<Crossing> any_crossing(const Vec3& from, const Vec3& to) const {
    const auto hit =
        tree_.any_intersected_primitive(Kernel::Segment_3(to_point(from), to_point(to)));
    if (!hit) return std::nullopt;
    return Crossing{from + fraction_at(**hit, from, to) * (to - from), kVoid, 0};
  }

  /// Fractions of the segment at which it crosses triangles, ascending, with 0 and 1.
  std::vector<double> cuts(const Vec3& from, const Vec3& to) const {
    std::vector<Triangles::const_iterator> hits;
    tree_.all_intersected_primitives(Kernel::Segment_3(to_point(from), to_point(to)),
                                     std::back_inserter(hits));
    std::vector<double> fractions{0, 1};
    for (const auto& hit : hits) fractions.push_back(fraction_at(*hit, from, to));
    std::sort(fractions.begin(), fractions.end());
    return fractions;
  }

  std::optional<Crossing> first_crossing(const Vec3& from, const Vec3& to) const {
    const std::vector<double> cut = cuts(from, to);
    if (cut.size() == 2 && walls_.empty()) return std::nullopt;
    const auto at = [&](double fraction) { return from + fraction * (to - from); };
    std::optional<std::int32_t> before;
    for (std::size_t i = 1; i < cut.size(); ++i) {
      if (!(cut[i] > cut[i - 1])) continue;  // an edge or corner of several triangles
      const Piece piece = look_along(at(cut[i - 1]), at(cut[i]));
      if (before && *before != piece.region) {
        return ordered(at(cut[i - 1]), *before, piece.region);
      }
      if (piece.wall) return piece.wall;
      before = piece.region;
    }
    return std::nullopt;
  }

  /// What a segment between two surfaces meets: the region at its begin and the first wall of a
  /// layer on its way.
  struct Piece {
    std::int32_t region = kVoid;
    std::optional<Crossing> wall;
  };

  Piece look_along(const Vec3& from, const Vec3& to) const {
    const Vec3 middle = 0.5 * (from + to);
    if (walls_.empty() || owner_at(middle) != kMatrix) return {region(middle), std::nullopt};
    return look_for_wall(from, to);
  }

  /// The distance to the skin changes by at most the way: no wall is nearer than the distance to
  /// it says.
  Piece look_for_wall(const Vec3& from, const Vec3& to) const {
    const double length = norm(to - from);
    const auto at = [&](double way) { return from + (way / length) * (to - from); };
    double way = 0, last = 0, here = depth(from);
    Piece piece{region_at_depth(here), std::nullopt};
    while (way < length) {
      last = way;
      way = std::min(length, way + std::max(distance_to_wall(here), step_));
      here = depth(at(way));
      if (region_at_depth(here) == piece.region) continue;
      piece.wall = between(at(last), at(way), piece.region);
      break;
    }
    return piece;
  }

  /// Bisection: `from` lies in `region`, `to` does not.
  Crossing between(Vec3 from, Vec3 to, std::int32_t region) const {
    std::int32_t beyond = region_at_depth(depth(to));
    for (int halving = 0; halving < 30; ++halving) {
      const Vec3 middle = 0.5 * (from + to);
      const std::int32_t here = region_at_depth(depth(middle));
      (here == region ? from : to) = middle;
      if (here != region) beyond = here;
    }
    return ordered(0.5 * (from + to), region, beyond);
  }

  double depth(const Vec3& x) const { return norm(skin_.closest(x).point - x); }

  std::int32_t region_at_depth(double depth) const {
    for (std::size_t i = 0; i < walls_.size(); ++i)
      if (depth < walls_[i]) return domain_.layers[i].region;
    return 0;
  }

  double distance_to_wall(double depth) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const double wall : walls_) nearest = std::min(nearest, std::abs(depth - wall));
    return nearest;
  }

  static constexpr int kOutside = -2, kMatrix = -1;

  /// The enclosure that a point belongs to, or kOutside or kMatrix.
  int owner_at(const Vec3& x) const {
    if (!skin_.contains(x)) return kOutside;
    for (std::size_t i = inside_.size(); i-- > 0;)
      if (inside_[i].contains(x)) return static_cast<int>(i);
    return kMatrix;
  }

  void add_seeds(const Surface& surface, const SizeField& spacing,
                 std::vector<Crossing>& all) const {
    const double own = largest_dimension(surface.points) / 4;
    const double reach = kSide * own;
    const auto nearer = [&](const Vec3& x) { return std::min(own, spacing(x)); };
    for (const Sample& sample : thinned(sample_surface(surface, own / 8), nearer)) {
      const std::int32_t within = region(sample.point - reach * sample.outward);
      const std::int32_t beyond = region(sample.point + reach * sample.outward);
      if (within != beyond) all.push_back(ordered(sample.point, within, beyond));
    }
  }

  void add_seeds_of_wall(double wall, const SizeField& spacing, std::vector<Crossing>& all) const {
    for (const Sample& sample : thinned(sample_surface(domain_.skin, step_ * 8), spacing)) {
      const Vec3 x = sample.point - wall * sample.outward;
      if (owner_at(x) != kMatrix || std::abs(depth(x) - wall) > kSide * wall) continue;
      const auto above = region_at_depth(wall * (1 - kSide));
      const auto below = region_at_depth(wall * (1 + kSide));
      if (above != below) all.push_back(ordered(x, above, below));
    }
  }

  static constexpr double kSide = 1e-6;  // a step to the side of a surface, in parts of its size

  Domain domain_;
  double step_;
  SurfaceQuery skin_;
  std::vector<SurfaceQuery> inside_;
  Triangles triangles_;
  Tree tree_;
  std::vector<double> walls_;  // m, distance of each wall from the skin
};

}  // namespace

std::unique_ptr<Oracle> make_oracle(const Domain& domain, double step) {
  return std::make_unique<SurfaceOracle>(domain, step);
}

}  // namespace palpate::mesher
