// SPDX-License-Identifier: AGPL-3.0-or-later
// How far a surface lies from another one.
#pragma once

#include "mesher/geometry/faulty_faces.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

struct Change {
  double distance = 0;    ///< m, the largest
  Vec3 at{};              ///< m, where
  double far_area = 0;    ///< m^2, of the triangles whose middle is farther than `far`
  double area = 0;        ///< m^2, of all
  FaultyFaces far_faces;  ///< those triangles
  double far_fraction() const { return area > 0 ? far_area / area : 0; }
};

/// Distances of the corners and the middles of the triangles of `from` from `to`; both may be open.
/// @param far m
Change change_between(const Surface& from, const Surface& to, double far);

/// Gives each triangle the names of the nearest triangle of `before`.
/// @param names_of of each triangle of `before`
void hand_on_names(Surface& surface, const Surface& before,
                   const std::vector<std::size_t>& names_of);

}  // namespace palpate::mesher
