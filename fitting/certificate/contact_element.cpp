// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/contact_element.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/certificate/range.hpp"

namespace palpate::fitting {
namespace {

const NodeResponse& response(const Library& library, std::int32_t vertex) {
  return library.responses[static_cast<std::size_t>(vertex)];
}

CurveTriple curves_of(const Library& library, const Triangle& triangle, const TriangleFrame& frame,
                      ResponseCurve NodeResponse::*kind) {
  return {{runtime::CompiledCurve(response(library, triangle[0]).*kind),
           runtime::CompiledCurve(response(library, triangle[1]).*kind),
           runtime::CompiledCurve(response(library, triangle[2]).*kind)},
          frame.gradient};
}

CurveTriple couplings_of(const Library& library, const Triangle& triangle,
                         const TriangleFrame& frame) {
  const auto curve = [&](std::size_t l) {
    const CouplingCurve& coupling = response(library, triangle[l]).coupling;
    return runtime::CompiledCurve(coupling.curve, static_cast<double>(coupling.base));
  };
  return {{curve(0), curve(1), curve(2)}, frame.gradient};
}

}  // namespace

bool has_responses(const Library& library, const Triangle& triangle) {
  return std::none_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
    return response(library, v).status == ResponseStatus::Hole;
  });
}

ContactElement contact_element(const Library& library, std::size_t index, double depth,
                               double friction) {
  const Triangle& triangle = library.triangles[index];
  const TriangleFrame frame = triangle_frame(library, index);
  ContactElement element{frame, curves_of(library, triangle, frame, &NodeResponse::normal),
                         curves_of(library, triangle, frame, &NodeResponse::lateral), friction,
                         depth};
  if (library.kind == ResponseKind::Coupled)
    element.coupling = couplings_of(library, triangle, frame);
  element.relaxes = library.relaxes();
  for (std::size_t l = 0; l < 3; ++l) {
    element.lean[l] = vec3_of(response(library, triangle[l]).lean);
    element.soft_axis[l] = vec3_of(response(library, triangle[l]).soft_axis);
  }
  return element;
}

/// B is the mean of the (P b_l)(P b_l)^T.
double ContactElement::most_softening() const {
  double largest = 0;
  for (const Vec3& b : soft_axis) largest = std::max(largest, dot(b, b));
  return largest > 0 ? kRoundingFactor * largest : 0;
}

/// dB/ds is P (sum (grad n_l . tau) b_l b_l^T) P less what turns with n, theory (6c): the first
/// part is at most the Frobenius norm of the gradient of sum n_l b_l b_l^T.
double ContactElement::most_softening_change() const {
  double squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const auto entry = [&](std::size_t l) { return soft_axis[l][i] * soft_axis[l][j]; };
      const Vec3 gradient =
          (entry(1) - entry(0)) * frame.gradient[1] + (entry(2) - entry(0)) * frame.gradient[2];
      squares += dot(gradient, gradient);
    }
  }
  return kRoundingFactor * (std::sqrt(squares) + 2 * most_softening() * frame.kappa);
}

/// sigma is the mean of those of the vertices, weighted, less its part along n. w does not fall.
double ContactElement::most_lean(const Range& z) const {
  if (!leans()) return 0;
  double largest = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    const double length = norm(lean[l]);
    largest = std::max(largest, coupling ? coupling->curves()[l].weight(z.high) * length : length);
  }
  return largest > 0 ? kRoundingFactor * largest : 0;
}

/// With the sum S = sum n_l w_l sigma_l: d sigma/ds = dS/ds across n - (n . S) dn/ds, and |dS/ds|
/// is at most the Frobenius norm of its gradient, which is convex in the w_l: largest at a corner
/// of their ranges.
double ContactElement::most_lean_change(const Range& z) const {
  if (!leans()) return 0;
  double largest = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<Vec3, 3> at = lean;
    for (std::size_t l = 0; coupling && l < 3; ++l) {
      const Range w = weight_range(coupling->curves()[l], z);
      at[l] = (((corner >> l) & 1u) != 0 ? w.high : w.low) * at[l];
    }
    const Vec3 first = at[1] - at[0], second = at[2] - at[0];
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 gradient = first[i] * frame.gradient[1] + second[i] * frame.gradient[2];
      squares += dot(gradient, gradient);
    }
    largest = std::max(largest, squares);
  }
  return kRoundingFactor * (std::sqrt(largest) + most_lean(z) * frame.kappa);
}

double ContactElement::most_lean_growth(const Range& z) const {
  if (!coupling || !leans()) return 0;
  double largest = 0;
  for (std::size_t l = 0; l < 3; ++l)
    largest = std::max(largest, slope_range(coupling->curves()[l], z).high * norm(lean[l]));
  return kRoundingFactor * largest;
}

double ContactElement::stretch(const Range& z) const {
  const double s = most_lean(z);
  return s > 0 ? kRoundingFactor * (1 + s * (s / 2 + std::sqrt(1 + s * s / 4))) : 1;
}

std::vector<double> ContactElement::depth_cells(double deepest) const {
  std::vector<double> ends = normal.cells({0, deepest}, 1);
  if (!coupling) return ends;
  const std::vector<double> more = coupling->cells({0, deepest}, 1);
  ends.insert(ends.end(), more.begin(), more.end());
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

}  // namespace palpate::fitting
