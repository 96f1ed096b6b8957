// SPDX-License-Identifier: AGPL-3.0-or-later
// What fills a body: the skin and the regions inside it.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/surface.hpp"
#include "mesher/volume/oracle.hpp"

namespace palpate::mesher {

/// A layer of the body below the skin, or below the layer before it.
struct Layer {
  double thickness = 0;     ///< m
  std::int32_t region = 0;  ///< index into Domain::region_names
};

/// A closed surface and what fills it.
struct Enclosure {
  Surface surface;
  std::int32_t region = 0;  ///< index into Domain::region_names, or kVoid
};

/// Surfaces may touch, cross and contain one another: a point belongs to the last enclosure that
/// contains it, else to the layer at its distance from the skin, else to region 0. Outside the skin
/// all is void, so what an enclosure has there is cut off.
struct Domain {
  Surface skin;
  std::vector<Layer> layers;          ///< outermost first
  std::vector<Enclosure> enclosures;  ///< later ones win
  std::vector<std::string> region_names;
};

}  // namespace palpate::mesher
