// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace palpate::fem {

/// The element: the dilatation at which its volumetric energy is evaluated, and whether its
/// displacements are quadratic (Tet10) or linear (Tet4).
enum class Dilatation {
  Mean,       ///< at the mean dilatation: an element-constant pressure
  Nodal,      ///< at the means around the corner nodes: a continuous linear pressure
  Pointwise,  ///< at every Gauss point: the pure displacement element, which locks near nu = 1/2
  /// Linear, at the means around the nodes [Bonet & Burton 1998]: for quick looks
  LinearNodal,
};

constexpr bool is_linear(Dilatation dilatation) {
  return dilatation == Dilatation::LinearNodal;
}

/// Whether the volumetric energy belongs to the nodes (fem/solid/nodal_pressure.hpp).
constexpr bool has_nodal_pressure(Dilatation dilatation) {
  return dilatation == Dilatation::Nodal || dilatation == Dilatation::LinearNodal;
}

/// Name in the provenance, as "Tet10, element-constant pressure".
inline const char* name_of(Dilatation dilatation) {
  switch (dilatation) {
    case Dilatation::Mean:
      return "Tet10, element-constant pressure";
    case Dilatation::Nodal:
      return "Tet10, nodal pressure";
    case Dilatation::Pointwise:
      return "Tet10, pure displacement";
    case Dilatation::LinearNodal:
      return "Tet4, nodal pressure: for quick looks";
  }
  return "";
}

}  // namespace palpate::fem
