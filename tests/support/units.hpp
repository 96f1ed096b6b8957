// SPDX-License-Identifier: AGPL-3.0-or-later
// The same body in other units: what a formula gives of it shows whether its dimensions agree.
#pragma once

#include "format/library.hpp"

namespace palpate::test {

/// One of these units is so many of the others. Powers of two change no digit.
struct Units {
  double force = 1, length = 1, time = 1;
};

inline Library in_units(Library library, const Units& units) {
  const auto convert = [](ResponseCurve& curve, double slope, double knot) {
    for (float& d : curve.knot) d = static_cast<float>(knot * static_cast<double>(d));
    for (float& s : curve.slope) s = static_cast<float>(slope * static_cast<double>(s));
  };
  for (Vec3& x : library.positions) x = units.length * x;
  for (NodeResponse& node : library.responses) {
    convert(node.normal, units.force / units.length, units.length);
    convert(node.lateral, units.force / units.length, units.length);
    convert(node.coupling.curve, 1 / units.length, units.length);
  }
  library.tool_radius *= units.length;
  for (double& time : library.relaxation_times) time *= units.time;
  return library;
}

}  // namespace palpate::test
