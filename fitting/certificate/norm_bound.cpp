// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/norm_bound.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "format/numbers.hpp"

namespace palpate::fitting {
namespace {

/// Most steps of Newton's method to an eigenvalue: an eigenvalue of multiplicity two is approached
/// by halves.
constexpr int kMostSteps = 40;
/// Bound of the round-off of the polynomial, over the cube of the trace, and of the variance of the
/// eigenvalues, over its square.
constexpr double kRoundOff = 1e-14;

/// The largest eigenvalue of a symmetric matrix without negative eigenvalues, or a number above it,
/// by Newton's method on the characteristic polynomial. All its roots are real: the method comes
/// down to the largest one and does not pass it. It begins where no eigenvalue is larger, sqrt(2)
/// standard deviations above their mean [Samuelson 1968], and ends where the polynomial is of the
/// size of its round-off.
double largest_eigenvalue(const Eigen::Matrix3d& S) {
  const double trace = S.trace(), mean = trace / 3, squares = S.squaredNorm();
  const double second = 0.5 * (trace * trace - squares), third = S.determinant();
  const double variance = std::max(0.0, squares / 3 - mean * mean) + kRoundOff * trace * trace;
  double x = mean + std::sqrt(2 * variance);
  for (int step = 0; step < kMostSteps; ++step) {
    const double value = ((x - trace) * x + second) * x - third;
    const double slope = (3 * x - 2 * trace) * x + second;
    if (!(value > kRoundOff * trace * trace * trace)) break;
    x -= value / slope;
  }
  return x;
}

}  // namespace

double norm_bound(const std::array<std::array<Range, 3>, 3>& entry) {
  Eigen::Matrix3d middle;
  double radii = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      middle(static_cast<int>(i), static_cast<int>(j)) = entry[i][j].middle();
      const double radius = entry[i][j].radius();
      radii += radius * radius;
    }
  }
  const double norm = std::sqrt(largest_eigenvalue(middle.transpose() * middle)) + std::sqrt(radii);
  return std::isfinite(norm) ? norm : kInfinity;
}

}  // namespace palpate::fitting
