// SPDX-License-Identifier: AGPL-3.0-or-later
// The derivative of the force by the place of a tool that slides, bounded over sets of states.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fitting/certificate/contact_element.hpp"
#include "fitting/certificate/range.hpp"

namespace palpate::fitting {

/// A set of states at limiting friction. One state has all corners alike and ranges of one number.
struct SlideCell {
  using Natural = std::array<double, 3>;
  std::array<Natural, 3> part{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< of the triangle, its corners
  Range azimuth;  ///< of tau in the plane of the facet, rad
  Range z;        ///< m, without a knot of a normal response or of w inside
  Range reach;    ///< m, z + d0
};

/// What makes a slide steep, N/m: |M_0|, and |v_i| |w| of the causes i that v is the sum of.
struct SlideCauses {
  double stiffness = 0;  ///< Lipschitz bound of the responses at a fixed contact point
  double variation = 0;  ///< change of the responses over the surface
  double slant = 0;      ///< directions u_l that lean against the facet
  double curvature = 0;  ///< turning of n
};

/// df/dx' = M_0 + v w^T of (8) in docs/theory-fitting.md, entry by entry in the frame (n, t, s),
/// with interval arithmetic. Immutable; any thread may evaluate.
class SlideJacobian {
 public:
  /// @pre element.friction > 0; the element outlives this
  explicit SlideJacobian(const ContactElement& element);

  /// No smaller than the norm of df/dx', N/m, at every state of the cell, nor than that of a slide
  /// held back in part or altogether; of one state, the largest of these. Infinite where the slide
  /// is not bounded; 0 where nothing slips.
  double bound(const SlideCell& cell) const;

  /// Of one state. Infinite where its slide is not bounded.
  SlideCauses causes(const SlideCell& state) const;

 private:
  struct Facet;     // what the place and the azimuth give
  struct Response;  // what the curves give
  struct AtVertex;
  struct Terms;  // of (8) and (9)

  Facet facet(const SlideCell& cell) const;
  double slip_at(const std::array<double, 3>& weight, double limit, bool largest) const;
  Range slip_limit(const SlideCell& cell) const;
  AtVertex at_vertex(std::size_t vertex, const Range& z, const Range& rho) const;
  Response response(const SlideCell& cell, const Range& rho) const;
  Terms terms(const SlideCell& cell, const Range& rho) const;
  /// The part of the gradient along tau of a quantity with these values at the vertices.
  Range along(const Facet& facet, const std::array<Range, 3>& values) const;

  /// The lateral responses of the three vertices from a knot of any of them to the next.
  struct LateralPiece {
    double start = 0;
    std::array<double, 3> force{}, slope{}, curvature{};
  };

  const ContactElement* element_;
  std::vector<LateralPiece> lateral_;  ///< the last one has no end
  // In the frame of the facet: along N, and two axes x, y in the plane.
  std::array<std::array<double, 3>, 3> direction_{};  ///< u_l
  std::array<std::array<double, 2>, 3> gradient_{};   ///< grad n_l
};

}  // namespace palpate::fitting
