// SPDX-License-Identifier: AGPL-3.0-or-later
// What the Delaunay refinement asks of a domain: which region holds a point, and where a segment
// leaves one region for another.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// The region of points outside the body, in voids too.
inline constexpr std::int32_t kVoid = -1;

/// A length by place.
using SizeField = std::function<double(const Vec3&)>;

/// A point of an interface and the regions on its two sides, the smaller first.
struct Crossing {
  Vec3 point{};
  std::int32_t low = kVoid, high = kVoid;
};

/// Answers depend on the arguments alone.
class Oracle {
 public:
  virtual ~Oracle() = default;

  /// The region that holds the point; kVoid outside.
  virtual std::int32_t region(const Vec3& point) const = 0;

  /// A point of the segment where the region changes, if there is one.
  virtual std::optional<Crossing> crossing(const Vec3& from, const Vec3& to) const = 0;

  /// Points of every interface, no two of one interface nearer than `spacing` at one of them: the
  /// first nodes of the mesh.
  virtual std::vector<Crossing> seeds(const SizeField& spacing) const = 0;

  /// The distance to the nearest surface, which need not be an interface.
  virtual double distance(const Vec3& point) const = 0;

  /// The bounds of all that is not void.
  virtual Bounds box() const = 0;

  /// The volume of all that is not void.
  virtual double volume() const = 0;

  /// Whether at most two regions, the void among them, meet at any point.
  virtual bool has_one_region() const = 0;
};

}  // namespace palpate::mesher
