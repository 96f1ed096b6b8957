// SPDX-License-Identifier: AGPL-3.0-or-later
// Inward directions with which slides have a bound.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// What a slide is asked to be bounded for.
struct SlideDemand {
  double depth = 0;  ///< m, z + d0 at most
  /// mu g'/h': how far friction moves the contact point while the tool is lifted. Half-spaces of
  /// incompressible solids have 1.5 mu, so that this is that of mu = 1/3.
  double lift = 0.5;
};

/// Least rate r over the triangle at which the lateral deflection falls while the contact point
/// moves, (10b) of docs/theory-fitting.md for responses that do not vary: over contact points,
/// azimuths, depths and slip limits at the ends of their ranges. A slide has no bound where it is
/// not positive.
/// @param points of the triangle  @param inward unit directions at these
double slide_rate(const std::array<Vec3, 3>& points, const std::array<Vec3, 3>& inward,
                  const SlideDemand& demand);

struct SlideDirections {
  std::vector<Vec3> inward;  ///< unit
  /// Triangles whose slides have no bound, or nearly none: before and after.
  std::size_t unbounded = 0, still_unbounded = 0;
};

/// Turns directions where slides have no bound, or nearly none, and within two rings around: they
/// are smoothed first, then each is turned by steps that raise the least rates around it. All
/// others stay as they are. No direction turns by more than 34 degrees.
/// @param free whether a vertex has a response: the direction of others stays, and triangles at
///   them need no bound
/// @param allowed whether the directions of a triangle (its index) meet what else is asked of them
SlideDirections slide_directions(
    const Surface& response, std::vector<Vec3> inward, const std::vector<bool>& free,
    const SlideDemand& demand,
    const std::function<bool(std::size_t, const std::array<Vec3, 3>&)>& allowed);

}  // namespace palpate::mesher
