// SPDX-License-Identifier: Apache-2.0
// Moving the contact point over the triangles.
#pragma once

#include "format/vec3.hpp"
#include "runtime/delivery.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

struct Walk {
  SurfacePoint point;
  bool at_border = false;  ///< a border of the response surface stopped it
  bool awaiting = false;   ///< a triangle that is not delivered stopped it
  bool hindered = false;   ///< it followed an edge, or ended early
};

/// Moves a point over the surface by `distance` (m, >= 0) along the projection of `direction`, of
/// any length, on the plane of its element. At an edge the direction is projected anew on the
/// neighbour, and the rest of the distance is walked there. Where there is no neighbour, or the new
/// direction does not point into it, the point follows the edge by the component of the motion
/// along it, or stays. A neighbour that is not among `delivered` (null: all are) counts as
/// missing. noexcept, allocation-free, at most 64 edges.
Walk walk(const Surface& surface, const SurfacePoint& from, const Vec3& direction, double distance,
          const Delivery* delivered = nullptr) noexcept;

}  // namespace palpate::runtime
