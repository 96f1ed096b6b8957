// SPDX-License-Identifier: AGPL-3.0-or-later
// Suprema of interpolated curves over a triangle and a range of deflections.
#pragma once

#include <array>
#include <vector>

#include "fitting/certificate/range.hpp"
#include "format/vec3.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {

/// Slopes of a curve over a range of deflections, exact.
Range slope_range(const runtime::CompiledCurve& curve, const Range& range);

/// The curves of one kind at the three vertices of a triangle, interpolated as
/// f_c(d) = sum n_l(c) f_l(d). The value is linear in the natural coordinates, so its extrema are
/// at vertices. In the deflection, bounds are taken over pieces without a knot inside, where force
/// and energy are polynomials: they lie in the convex hull of their Bernstein coefficients, and a
/// norm is largest at a corner of the hull. No bound relies on sampling.
class CurveTriple {
 public:
  CurveTriple(std::array<runtime::CompiledCurve, 3> curves, const std::array<Vec3, 3>& gradient);

  const std::array<runtime::CompiledCurve, 3>& curves() const { return curves_; }
  double last_knot() const;  ///< the deepest of the three
  double max_slope() const;  ///< over all deflections

  double least_force(double d) const;     ///< over the triangle
  double greatest_force(double d) const;  ///< over the triangle
  Range slope(const Range& range) const;  ///< over the triangle and the range, exact
  /// sup |grad_c f_c(d)|, N/m
  double force_gradient(const Range& range) const;
  /// sup |grad_c E_c(d)| / f_c(d), 1; finite down to d = 0. Infinite where the force is zero.
  double energy_ratio(const Range& range) const;
  /// Deflections rho with f_c(rho) equal to the interpolated force, over the triangle, for vertex
  /// forces between low[l] and high[l]. The upper end is infinite where a curve stays below its
  /// force.
  Range inverse(const std::array<double, 3>& low, const std::array<double, 3>& high) const;
  /// Ends of cells that cover the range without a knot inside; each piece is divided into `parts`.
  std::vector<double> cells(const Range& range, int parts) const;

 private:
  double cell_force_gradient(double low, double high) const;
  double cell_energy_gradient(double low, double high) const;
  double first_piece_ratio(double high) const;

  std::array<runtime::CompiledCurve, 3> curves_;
  std::array<Vec3, 3> gradient_;
  double first_knot_ = 0;  ///< end of the piece at 0 that all three have in common
};

}  // namespace palpate::fitting
