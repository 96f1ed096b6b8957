// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <string>

#include "fem/laws/fibre_samples.hpp"
#include "format/vec3.hpp"

namespace palpate::fem {

/// A box along the axes, its faces included.
struct FibreBox {
  Vec3 low{}, high{};  ///< m
  bool operator==(const FibreBox&) const = default;

  bool holds(const Vec3& X) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (!(X[i] >= low[i] && X[i] <= high[i])) return false;
    return true;
  }
};

/// Directions of the fibres of a region at rest. Two orthogonal unit vectors span the plane of the
/// fibres at every point, `mean` and `across`; the families lie at +angle and -angle from `mean`
/// towards `across`.
struct FibreField {
  enum class Kind {
    Constant,     ///< mean = first, across = the part of second that is normal to it
    Cylindrical,  ///< mean = around the axis, across = along it, as in the wall of a vessel
    Sampled,      ///< mean and across of the nearest sample; without an across, as Constant
    Laplace       ///< mean = along the gradient of a potential; to be sampled on a body first
  };

  Kind kind = Kind::Constant;
  Vec3 first{1, 0, 0};   ///< Constant: mean direction; Cylindrical: the axis, any length
  Vec3 second{0, 1, 0};  ///< Constant: a direction in the plane of the fibres
  Vec3 origin{};         ///< Cylindrical: a point of the axis, m
  double angle = 0;      ///< rad
  std::shared_ptr<const FibreSamples> samples;  ///< Sampled; may be missing until it is used
  FibreBox from, to;  ///< Laplace: where on the surface the fibres begin and end
  int families = 1;   ///< 1: the one at +angle; 2: both
  bool operator==(const FibreField&) const = default;

  /// Unit vectors of the families at X; not of Laplace, nor of Sampled without samples. With one
  /// family, both are that one. On the axis of a cylindrical field, where no direction is around
  /// it, any direction normal to it is taken.
  std::array<Vec3, 2> at(const Vec3& X) const;

  /// @throws Error(Configuration) for directions that are zero, parallel or not finite, an angle
  /// outside 0 .. 90 degrees, or other than one or two families.
  void check(const std::string& where) const;
};

}  // namespace palpate::fem
