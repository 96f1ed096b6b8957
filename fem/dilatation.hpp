// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace palpate::fem {

/// Where the volumetric energy of an element is taken, and with it what its pressure is like.
enum class Dilatation {
  Mean,       ///< at the mean dilatation: an element-constant pressure
  Nodal,      ///< at the means around the corner nodes: a continuous, linear pressure
  Pointwise,  ///< at every Gauss point: the pure displacement element, which locks near nu = 1/2
};

/// For the provenance: "Tet10, element-constant pressure" ..
inline const char* name_of(Dilatation dilatation) {
  switch (dilatation) {
    case Dilatation::Mean:
      return "Tet10, element-constant pressure";
    case Dilatation::Nodal:
      return "Tet10, nodal pressure";
    case Dilatation::Pointwise:
      return "Tet10, pure displacement";
  }
  return "";
}

}  // namespace palpate::fem
