// SPDX-License-Identifier: AGPL-3.0-or-later
// Grids for ParaView: the body, a deformed state of it, the response library.
#pragma once

#include <cstdint>
#include <vector>

#include "app/vtkhdf/vtkhdf.hpp"
#include "format/body.hpp"
#include "format/library.hpp"

namespace palpate::vtkhdf {

/// Tetrahedra with `region` per cell (the names are in its description); per point `fixed` (1 at a
/// fixed node), `response` (1 at a response vertex), `site` (1 where the tool may press)
/// and `inward` (u^z at a response vertex, else zero).
Grid body_grid(const Body& body);

/// Fields of a deformed state, in the order of Body::nodes and Body::tetrahedra. Plain arrays, so
/// that this folder does not depend on a solver.
struct DeformedFields {
  std::vector<Vec3> displacement;             ///< (N) m
  std::vector<double> strain_energy_density;  ///< (T) J/m^3
  std::vector<double> pressure;               ///< (T) Pa, tension positive
  std::vector<double> smooth_pressure;        ///< (T) Pa, the same without checkerboards
};

/// body_grid in the reference position with `displacement` per point (ParaView: Warp By Vector) and
/// `strain_energy_density`, `pressure` and `smooth_pressure` per cell.
/// @throws Error(Internal) when the size of a field differs from that of the body.
Grid deformed_grid(const Body& body, const DeformedFields& fields);

/// Triangles of the library. Per point: `inward`, `status`, the errors of the fit, and at
/// deflection `depth` (m) force and slope of the normal and the lateral response; NaN at a hole.
/// Per cell, once certified: `stick`, `slip`, `kappa`, `cos_theta`, `sliding_passive`.
/// @throws Error(Configuration) for a depth that is not positive and finite.
Grid library_grid(const Library& library, double depth);

}  // namespace palpate::vtkhdf
