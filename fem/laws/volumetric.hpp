// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fem/laws/scalar.hpp"

namespace palpate::fem {

/// The volumetric penalty that all split laws share [Simo & Taylor 1991]:
///   U(J) = kappa/4 (J^2 - 1 - 2 ln J).
class LogQuadraticVolume {
 public:
  explicit LogQuadraticVolume(double kappa) : kappa_(kappa) {}

  double kappa() const { return kappa_; }  ///< bulk modulus, Pa

  /// U, dU/dJ and d2U/dJ2.
  template <class T>
  T volumetric_energy(const T& J) const {
    return (0.25 * kappa_) * (J * J - 1.0 - 2.0 * logarithm(J));
  }
  template <class T>
  T pressure(const T& J) const {
    return (0.5 * kappa_) * (J - 1.0 / J);
  }
  template <class T>
  T pressure_slope(const T& J) const {
    return (0.5 * kappa_) * (1.0 + 1.0 / (J * J));
  }

 private:
  double kappa_;
};

}  // namespace palpate::fem
