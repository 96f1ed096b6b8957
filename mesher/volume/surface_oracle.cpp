// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/surface_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/volume/inside_grid.hpp"
#include "mesher/volume/samples.hpp"
#include "mesher/volume/triangle_cloud.hpp"

namespace palpate::mesher {
namespace {

/// The triangles of the skin and of all enclosures.
TriangleCloud cloud_of(const Domain& domain) {
  Surface all = domain.skin;
  for (const Enclosure& enclosure : domain.enclosures) append(all, enclosure.surface);
  return {all.points, all.triangles};
}

Crossing ordered(const Vec3& point, std::int32_t a, std::int32_t b) {
  return {point, std::min(a, b), std::max(a, b)};
}

/// Drops crossings close to an earlier one: surfaces that touch have some.
std::vector<Crossing> apart(const std::vector<Crossing>& crossings, const SizeField& spacing) {
  std::vector<Vec3> points;
  for (const Crossing& crossing : crossings) points.push_back(crossing.point);
  std::vector<Crossing> kept;
  const SizeField quarter = [&](const Vec3& x) { return spacing(x) / 4; };
  for (const std::size_t i : thinned(points, quarter)) kept.push_back(crossings[i]);
  return kept;
}

class SurfaceOracle final : public Oracle {
 public:
  SurfaceOracle(const Domain& domain, double thinnest)
      : domain_(domain),
        thinnest_(thinnest),
        step_(thinnest / 10),
        skin_(domain_.skin),
        cloud_(cloud_of(domain_)) {
    for (const Enclosure& enclosure : domain_.enclosures) inside_.emplace_back(enclosure.surface);
    double depth = 0;
    for (const Layer& layer : domain_.layers) walls_.push_back(depth += layer.thickness);
  }

  std::int32_t region(const Vec3& x) const override {
    const int owner = owner_at(x);
    if (owner == kOutside) return kVoid;
    return owner == kMatrix ? region_in_matrix(x) : domain_.enclosures[to_index(owner)].region;
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
    return apart(all, spacing);
  }

  double distance(const Vec3& x) const override {
    const double surface = norm(cloud_.closest(x) - x);
    return walls_.empty() ? surface : std::min(surface, distance_to_wall(depth(x)));
  }

  double volume() const override {
    const bool has_void = std::any_of(domain_.enclosures.begin(), domain_.enclosures.end(),
                                      [](const Enclosure& e) { return e.region == kVoid; });
    return signed_volume(domain_.skin) * (has_void ? solid_fraction() : 1);
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
    const std::vector<double> hits = cloud_.hits(from, to);
    if (hits.empty()) return std::nullopt;
    // In and out again: a wall too thin for any element. At an acute edge there is always one.
    const bool through = hits.size() % 2 == 0;
    if (through && (hits.back() - hits.front()) * norm(to - from) < thinnest_) return std::nullopt;
    return Crossing{from + hits.front() * (to - from), kVoid, 0};
  }

  std::optional<Crossing> first_crossing(const Vec3& from, const Vec3& to) const {
    std::vector<double> cut = cloud_.hits(from, to);
    if (cut.empty() && walls_.empty()) return std::nullopt;
    cut.insert(cut.begin(), 0);
    cut.push_back(1);
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
    double way = 0;
    Piece piece{region_in_matrix(from), std::nullopt};
    while (way < length) {
      const double last = way;
      way = std::min(length, way + std::max(free_way(at(way)), step_));
      if (region_in_matrix(at(way)) == piece.region) continue;
      piece.wall = between(at(last), at(way), piece.region);
      break;
    }
    return piece;
  }

  /// A distance around the point in which there is no wall.
  double free_way(const Vec3& x) const {
    const auto range = skin_.distance_range(x);
    const double way = layer_at(range.low) == layer_at(range.high)
                           ? std::min(distance_to_wall(range.low), distance_to_wall(range.high))
                           : 0;
    return way > step_ ? way : distance_to_wall(depth(x));
  }

  /// Bisection: `from` lies in `region`, `to` does not.
  Crossing between(Vec3 from, Vec3 to, std::int32_t region) const {
    std::int32_t beyond = region_in_matrix(to);
    for (int halving = 0; halving < 30; ++halving) {
      const Vec3 middle = 0.5 * (from + to);
      const std::int32_t here = region_in_matrix(middle);
      (here == region ? from : to) = middle;
      if (here != region) beyond = here;
    }
    return ordered(0.5 * (from + to), region, beyond);
  }

  double depth(const Vec3& x) const { return norm(skin_.surface().closest(x).point - x); }

  /// The number of walls above this depth.
  std::size_t layer_at(double depth) const {
    return static_cast<std::size_t>(std::upper_bound(walls_.begin(), walls_.end(), depth) -
                                    walls_.begin());
  }

  std::int32_t region_of_layer(std::size_t layer) const {
    return layer < walls_.size() ? domain_.layers[layer].region : 0;
  }

  std::int32_t region_in_matrix(const Vec3& x) const {
    if (walls_.empty()) return 0;
    const auto range = skin_.distance_range(x);
    const std::size_t layer = layer_at(range.low);
    return region_of_layer(layer == layer_at(range.high) ? layer : layer_at(depth(x)));
  }

  double distance_to_wall(double depth) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const double wall : walls_) nearest = std::min(nearest, std::abs(depth - wall));
    return nearest;
  }

  /// The fraction of the points of a lattice inside the skin that lie in no void.
  double solid_fraction() const {
    const Bounds around = box();
    const Vec3 span = around.high - around.low;
    std::size_t inside = 0, solid = 0;
    for (int n = 0; n < kLattice * kLattice * kLattice; ++n) {
      const int i = n % kLattice, j = n / kLattice % kLattice, k = n / (kLattice * kLattice);
      const Vec3 place{(i + 0.5) / kLattice, (j + 0.5) / kLattice, (k + 0.5) / kLattice};
      const int owner =
          owner_at(around.low + Vec3{place[0] * span[0], place[1] * span[1], place[2] * span[2]});
      if (owner == kOutside) continue;
      ++inside;
      if (owner == kMatrix || domain_.enclosures[to_index(owner)].region != kVoid) ++solid;
    }
    return inside == 0 ? 1 : static_cast<double>(solid) / static_cast<double>(inside);
  }

  static constexpr int kLattice = 80;  // points along each side of the bounds
  static constexpr int kOutside = -2, kMatrix = -1;

  /// The enclosure that a point belongs to, or kOutside or kMatrix.
  int owner_at(const Vec3& x) const {
    if (!skin_.contains(x)) return kOutside;
    for (std::size_t i = inside_.size(); i-- > 0;)
      if (inside_[i].contains(x)) return static_cast<int>(i);
    return kMatrix;
  }

  /// Samples of a surface that the region changes at.
  std::vector<Sample> samples_of(const Surface& surface, const SizeField& spacing) const {
    const double own = largest_dimension(surface.points) / 4;
    return thinned(sample_surface(surface, own / 8),
                   [&](const Vec3& x) { return std::min(own, spacing(x)); });
  }

  void add_seeds(const Surface& surface, const SizeField& spacing,
                 std::vector<Crossing>& all) const {
    const double reach = kSide * largest_dimension(surface.points);
    for (const Sample& sample : samples_of(surface, spacing)) {
      const std::int32_t within = region(sample.point - reach * sample.outward);
      const std::int32_t beyond = region(sample.point + reach * sample.outward);
      if (within != beyond) all.push_back(ordered(sample.point, within, beyond));
    }
  }

  void add_seeds_of_wall(double wall, const SizeField& spacing, std::vector<Crossing>& all) const {
    for (const Sample& sample : samples_of(domain_.skin, spacing)) {
      const Vec3 x = sample.point - wall * sample.outward;
      if (owner_at(x) != kMatrix || std::abs(depth(x) - wall) > kSide) continue;
      const auto above = region_of_layer(layer_at(wall * (1 - kSide)));
      const auto below = region_of_layer(layer_at(wall * (1 + kSide)));
      if (above != below) all.push_back(ordered(x, above, below));
    }
  }

  static constexpr double kSide = 1e-6;  // a step to the side of a surface, in parts of its size

  Domain domain_;
  double thinnest_;
  double step_;  // along a segment that grazes the wall of a layer
  InsideGrid skin_;
  std::vector<InsideGrid> inside_;
  TriangleCloud cloud_;
  std::vector<double> walls_;  // m, distance of each wall from the skin
};

}  // namespace

std::unique_ptr<Oracle> make_oracle(const Domain& domain, double thinnest) {
  return std::make_unique<SurfaceOracle>(domain, thinnest);
}

}  // namespace palpate::mesher
