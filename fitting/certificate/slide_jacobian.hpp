// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounds of the derivative of the force by the position of a sliding tool, over sets of states.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fitting/certificate/contact_element.hpp"
#include "fitting/certificate/range.hpp"

namespace palpate::fitting {

namespace slide {
struct Facet;     // depends on the position and the azimuth
struct Response;  // depends on the curves
struct AtVertex;
struct Terms;  // of (8) and (9)
struct Axes;
struct Softening;  // S and its derivative
}  // namespace slide

/// A set of states at limiting friction. A single state has equal corners and ranges of one number.
struct SlideCell {
  using Natural = std::array<double, 3>;
  std::array<Natural, 3> part{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< corners, in the triangle
  Range azimuth;  ///< of tau in the plane of the facet, rad
  Range z;        ///< m; no knot of a normal response or of w inside
  Range reach;    ///< m, z + d0
};

/// Contributions to the force gradient of a slide, N/m: |M_0|, and |v_i| |w| for each term v_i of
/// v, each times |A|^2.
struct SlideCauses {
  double stiffness = 0;  ///< Lipschitz bound of the responses at a fixed contact point
  double variation = 0;  ///< change of the responses over the surface
  double slant = 0;      ///< directions u_l oblique to the facet
  double curvature = 0;  ///< turning of n
  double lean = 0;       ///< shear by a straight press, and its change over the surface
  double softening = 0;  ///< soft axes: their turning, and their change over the surface
};

/// df/dx' = M_0 + v w^T of (8) in docs/theory-fitting.md, entry by entry in the frame (n, t, s),
/// with interval arithmetic. Immutable; any thread may evaluate.
class SlideJacobian {
 public:
  /// @pre element.friction > 0; the element outlives this
  explicit SlideJacobian(const ContactElement& element);

  /// Upper bound of the norm of df/dx', N/m, at every state of the cell, for complete slides and
  /// for slides that are rate-limited in part or wholly. For a single state, the largest of these
  /// norms. Infinite where the slide is not bounded; 0 where the contact sticks.
  double bound(const SlideCell& cell) const;

  /// Contributions at a single state. Infinite where its slide is not bounded.
  SlideCauses causes(const SlideCell& state) const;

 private:
  using Facet = slide::Facet;
  using Response = slide::Response;
  using AtVertex = slide::AtVertex;
  using Terms = slide::Terms;
  using Axes = slide::Axes;
  using Softening = slide::Softening;
  using Turned = std::array<std::array<double, 3>, 3>;  ///< components of the vectors of vertices
  using Weights = std::array<Range, 3>;                 ///< of the vertices

  /// What w does while c slides and z changes: the slip limit follows it, or, as the contact grows
  /// and the lateral offset of the grip takes the rest, does not.
  enum class Grip { Renewed, Kept };

  static Turned turned(const std::array<std::array<double, 3>, 3>& vertex, const Facet& facet);
  static Axes interpolated(const SlideCell& cell, const Turned& vectors);
  static Axes interpolated(const SlideCell& cell, const Turned& vectors, const Weights& weights);
  /// Derivatives along tau.
  Axes rate(const Facet& facet, const Turned& vectors) const;
  Axes rate(const Facet& facet, const Turned& vectors, const Weights& weights) const;
  static Range along_t(const Facet& facet, const Axes& a);
  static Range along_s(const Facet& facet, const Axes& a);
  Facet facet(const SlideCell& cell) const;
  void add_lean(const SlideCell& cell, Facet& facet) const;
  Softening softening(const SlideCell& cell, const Facet& facet) const;
  void add_lean(const SlideCell& cell, Grip grip, Terms& terms) const;
  static void add_lean(const Terms& terms, Range& v_n, Range& v_t, Range& v_s);
  Range sheared_depth(const SlideCell& cell) const;
  double slip_at(const std::array<double, 3>& weight, double limit, bool largest) const;
  Range slip_limit(const SlideCell& cell) const;
  AtVertex at_vertex(std::size_t vertex, const Range& z, const Range& rho) const;
  Response response(const SlideCell& cell, const Range& rho) const;
  using Vector = std::array<Range, 3>;
  using Entries = std::array<Vector, 3>;
  /// Bound of the norm of A^T X A for X in the frame (n, t, s).
  double leaned_norm(const Facet& facet, const Entries& x) const;
  Terms terms_of_any_grip(const SlideCell& cell, const Range& rho) const;
  Terms with_grip(Terms x, const SlideCell& cell, Grip grip) const;
  double bound_of_response(const Terms& x) const;
  double bound_of_soft_response(const Terms& x) const;
  static Vector soft_turning(const Terms& x);
  static Vector lean_turning(const Terms& x);
  void add_softening(Terms& x) const;
  /// Derivative along tau of a quantity with these values at the vertices.
  Range along(const Facet& facet, const std::array<Range, 3>& values) const;

  /// The lateral responses of the three vertices between two consecutive knots of any of them.
  struct LateralPiece {
    double start = 0;
    std::array<double, 3> force{}, slope{}, curvature{};
  };

  const ContactElement* element_;
  std::vector<LateralPiece> lateral_;  ///< the last one has no end
  // In the frame of the facet: along N, and two axes x, y in the plane.
  std::array<std::array<double, 3>, 3> direction_{};  ///< u_l
  std::array<std::array<double, 2>, 3> gradient_{};   ///< grad n_l
  std::array<std::array<double, 3>, 3> lean_{};       ///< sigma_l, of coupled responses at w = 1
  std::array<std::array<double, 3>, 3> soft_axis_{};  ///< b_l
  bool leans_ = false, has_soft_axes_ = false;
};

}  // namespace palpate::fitting
