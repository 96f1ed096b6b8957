// SPDX-License-Identifier: AGPL-3.0-or-later
// What a body most likely lies on.
#pragma once

#include "mesher/geometry/surface.hpp"

namespace palpate::app {

/// The part of a surface beyond a plane.
struct Base {
  Vec3 down{};          ///< unit, out of the body
  double height = 0;    ///< m; the part is where dot(down, x) >= height
  double fraction = 0;  ///< of the area of the surface, beyond the plane
  bool is_flat = false;

  bool holds(const Vec3& x) const { return dot(down, x) >= height; }
};

/// A flat base if the surface has one: the largest outermost flat part, of at least 5 % of the
/// area. Else the lowest slab along the axis on which it stands broadest: a tenth to a third of the
/// extent, until it has 15 % of the area. Of parts that are nearly alike, that at the smallest z,
/// then that at the smallest y, which are down in most files.
/// @param surface closed, oriented outward
Base find_base(const mesher::Surface& surface);

}  // namespace palpate::app
