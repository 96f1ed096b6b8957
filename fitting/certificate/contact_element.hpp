// SPDX-License-Identifier: AGPL-3.0-or-later
// A response triangle with all that the bounds of its forces depend on.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "fitting/certificate/curve_bounds.hpp"
#include "fitting/certificate/range.hpp"
#include "fitting/certificate/triangle_frame.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

/// A triangle with its responses, the friction and the depth of its bounds.
struct ContactElement {
  TriangleFrame frame;
  CurveTriple normal;
  CurveTriple lateral;
  double friction = 0;
  double depth = 0;                                    ///< m, D: the bounds hold while z + d0 <= D
  std::optional<CurveTriple> coupling = std::nullopt;  ///< w, of coupled responses
  bool relaxes = false;  ///< slip may begin below mu g: bounds hold whatever the tissue remembers
  std::array<Vec3, 3> lean{};  ///< sigma_l, 1; of coupled responses at w = 1

  std::array<Vec3, 3> soft_axis{};  ///< b_l, 1, of coupled responses

  bool has_soft_axes() const { return soft_axis != std::array<Vec3, 3>{}; }
  double most_softening() const;  ///< sup |B| over the triangle
  /// sup |dB/ds| across n over the triangle, along any direction in its plane, 1/m
  double most_softening_change() const;
  bool leans() const { return lean != std::array<Vec3, 3>{}; }
  double most_lean(const Range& z) const;  ///< sup |sigma| over the triangle and a cell of depths
  /// sup |d sigma/ds| over the triangle and a cell of depths, along any direction in its plane, 1/m
  double most_lean_change(const Range& z) const;
  /// sup |d sigma/dz| over the triangle and a cell of depths, 1/m: it grows with the contact
  double most_lean_growth(const Range& z) const;
  /// |A|^2 for A = I - sigma n^T at the largest |sigma| over a cell of depths: what a bound of the
  /// forces in the response coordinates has to be multiplied by. 1 without lean.
  double stretch(const Range& z) const;

  /// Ends of intervals of depth from 0 to D, or to `deepest`, that have no knot of a normal
  /// response or of w inside.
  std::vector<double> depth_cells() const { return depth_cells(depth); }
  std::vector<double> depth_cells(double deepest) const;
};

/// Whether all three vertices have a response. Without them there is no local model.
bool has_responses(const Library& library, const Triangle& triangle);

/// @param depth  D, m
/// @throws Error(Geometry) where normals cannot be interpolated. @pre has_responses
ContactElement contact_element(const Library& library, std::size_t triangle, double depth,
                               double friction);

/// w(z) of a vertex over a cell of depths.
inline Range weight_range(const runtime::CompiledCurve& w, const Range& z) {
  return {w.weight(z.low), w.weight(z.high)};
}

}  // namespace palpate::fitting
