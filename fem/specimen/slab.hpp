// SPDX-License-Identifier: AGPL-3.0-or-later
// A sphere pressed into a wide slab on a rigid base, to which it is bonded: what a robot meets on
// an organ that lies on a table, as far as a press of one site knows.
#pragma once

#include <string>
#include <vector>

#include "fem/campaign/settings.hpp"

namespace palpate::fem {

struct SlabPress {
  ToolGeometry tool;  ///< a sphere
  ToolFriction friction = ToolFriction::Frictionless;
  LawConstants law;
  double thickness = 0;        ///< m
  std::vector<double> depths;  ///< m, ascending
};

struct SlabForces {
  std::vector<double> force;  ///< N, at the depths that were reached
  std::string reason;         ///< why the press ended early; empty when it did not
};

/// The slab is so wide that its border does not matter. Its state is that of a sector of 30 degrees
/// between two planes of symmetry, one element wide.
/// @throws Error(Configuration) for a tool that is no sphere, depths that do not ascend or reach
/// the
///   base, constants out of range.
SlabForces press_slab(const SlabPress& press);

}  // namespace palpate::fem
