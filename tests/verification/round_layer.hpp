// SPDX-License-Identifier: AGPL-3.0-or-later
// A round layer of prisms with its base fixed, refined towards a circle on the middle of its top.
#pragma once

#include "fem/campaign/indentation.hpp"

namespace palpate::test {

struct RoundLayer {
  double circle;  ///< m, radius of the circle
  int rings;      ///< of elements within it
  double
      crowding;  ///< 1: rings of even width; 2: ever narrower towards the circle, from both sides
  double thickness;  ///< m
  double extent;     ///< m, outer radius
};

/// The layer lies below z = 0; its only response vertex is the origin. The points on the circle are
/// the corners of a polygon with the area of the circle.
Body make_round_layer(const RoundLayer& layer);

/// One press at the only vertex, without lateral paths: neo-Hookean, `young` and `poisson`.
struct Pressed {
  SiteCurves curves;
  int nodes;

  double force() const { return -curves.paths.front().samples.back().force[2]; }  ///< N
};
Pressed press(const Body& body, double young, double poisson, const fem::ToolGeometry& tool,
              double depth, int increments, fem::Engine engine = fem::Engine::SharedFactor);

}  // namespace palpate::test
