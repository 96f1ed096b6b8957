// SPDX-License-Identifier: AGPL-3.0-or-later
// Hold-out points of a library: random points of its surface that are not sites, except on request.
#pragma once

#include <cstdint>
#include <vector>

#include "format/library.hpp"

namespace palpate::fidelity {

/// A point of the response surface and the direction in which the runtime presses it.
struct HoldOutPoint {
  std::int32_t triangle = -1;
  Vec3 natural{};     ///< natural coordinates in the triangle
  Vec3 position{};    ///< m
  Vec3 inward{};      ///< unit, n(c) of the interpolation
  bool node = false;  ///< at a vertex: the error of the fit alone, without interpolation
  double skin = 0;    ///< m, along `inward` to the skin of the body, where direct presses start
};

/// `off_node` points distributed uniformly over the area of the triangles with responses at all
/// three vertices, then up to `at_node` different vertices of such triangles with status Fitted.
/// The same seed draws the same points. @throws Error(Configuration) when no triangle has
/// responses.
std::vector<HoldOutPoint> draw_points(const Library& library, int off_node, int at_node,
                                      std::uint32_t seed);

}  // namespace palpate::fidelity
