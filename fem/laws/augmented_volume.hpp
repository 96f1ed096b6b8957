// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fem/laws/law.hpp"

namespace palpate::fem {

/// A law whose volumetric energy U, of a large bulk modulus kappa, is replaced by the augmented
/// Lagrangian of J = s [Hestenes 1969; Simo & Taylor 1991]:
///   U_p(J) = min over s of U(s) + p (J - s) + kappa_a/2 (J - s)^2,
///   dU_p/dJ = p + kappa_a (J - s) = U'(s),   d2U_p/dJ2 = kappa_a U''(s)/(kappa_a + U''(s)).
/// With U of LogQuadraticVolume, s is the positive root of
///   (kappa/2 + kappa_a) s^2 - (p + kappa_a J) s - kappa/2 = 0.
/// p <- dU_p/dJ is the step of the method of multipliers. It leaves p as it is where J = s, and
/// then U_p and its first derivative are those of U. The isochoric part is that of `law`.
struct AugmentedVolume {
  const Law& law;
  double kappa;    ///< bulk modulus at rest, Pa
  double kappa_a;  ///< of the penalty, Pa
  Lanes p;         ///< multipliers, Pa

  Lanes psi(const Tensor2<Lanes>& F, const Lanes& J, const Fibres<Lanes>& a) const {
    return law.psi(F, J, a);
  }
  Tensor2<Lanes> piola(const Tensor2<Lanes>& F, const Tensor2<Lanes>& cof, const Lanes& J,
                       const Fibres<Lanes>& a) const {
    return law.piola(F, cof, J, a);
  }
  void add_tangent(const Tensor2<Lanes>& F, const Tensor2<Lanes>& cof, const Lanes& J,
                   const Fibres<Lanes>& a, Tensor4<Lanes>& A) const {
    law.add_tangent(F, cof, J, a, A);
  }

  /// s, the dilatation that the law sees, for that of the element, J.
  Lanes law_dilatation(const Lanes& J) const {
    const Lanes b = p + kappa_a * J;
    const double a = 0.5 * kappa + kappa_a;
    return (b + (b * b + 2 * a * kappa).sqrt()) / (2 * a);
  }
  /// U_p, J/m^3.
  Lanes volumetric_energy(const Lanes& J) const {
    const Lanes s = law_dilatation(J), gap = J - s;
    return law.volumetric_energy(s) + p * gap + 0.5 * kappa_a * gap * gap;
  }
  /// dU_p/dJ, Pa.
  Lanes pressure(const Lanes& J) const { return law.pressure(law_dilatation(J)); }
  /// d2U_p/dJ2, Pa.
  Lanes pressure_slope(const Lanes& J) const {
    const Lanes slope = law.pressure_slope(law_dilatation(J));
    return kappa_a * slope / (kappa_a + slope);
  }
};

}  // namespace palpate::fem
