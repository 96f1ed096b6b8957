// SPDX-License-Identifier: AGPL-3.0-or-later
// Hyperelastic laws, split into an isochoric part, evaluated at every quadrature point, and a
// volumetric penalty U, evaluated at the mean dilatation of an element.
//
// A law is a template over its scalar T, so that one source serves a single point (double), eight
// elements at once (Lanes) and automatic differentiation. Tensors are row-major: F[3 i + J].
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "fem/laws/lanes.hpp"
#include "fem/laws/scalar.hpp"
#include "fem/laws/volumetric.hpp"

namespace palpate::fem {

template <class T>
using Tensor2 = std::array<T, 9>;
template <class T>
using Tensor4 = std::array<std::array<T, 9>, 9>;  ///< A[3 i + J][3 k + L] = dP_iJ / dF_kL

/// cof F = J F^-T, the derivative of J = det F.
template <class T>
Tensor2<T> cofactor(const Tensor2<T>& F) {
  return {F[4] * F[8] - F[5] * F[7], F[5] * F[6] - F[3] * F[8], F[3] * F[7] - F[4] * F[6],
          F[2] * F[7] - F[1] * F[8], F[0] * F[8] - F[2] * F[6], F[1] * F[6] - F[0] * F[7],
          F[1] * F[5] - F[2] * F[4], F[2] * F[3] - F[0] * F[5], F[0] * F[4] - F[1] * F[3]};
}

template <class T>
T determinant(const Tensor2<T>& F, const Tensor2<T>& cof) {
  return F[0] * cof[0] + F[1] * cof[1] + F[2] * cof[2];
}

template <class T>
T double_contraction(const Tensor2<T>& a, const Tensor2<T>& b) {
  T sum = a[0] * b[0];
  for (std::size_t i = 1; i < 9; ++i) sum += a[i] * b[i];
  return sum;
}

/// Nearly incompressible neo-Hookean solid [Bonet & Wood 2008, sec. 6.5]:
///   Psi = mu/2 (J^{-2/3} I1 - 3) + U(J),   U(J) = kappa/4 (J^2 - 1 - 2 ln J),
/// with the small-strain constants mu = E/(2(1+nu)), kappa = E/(3(1-2nu)).
class NeoHookean : public LogQuadraticVolume {
 public:
  /// @throws Error(Configuration) unless E > 0 and 0 <= nu < 0.5, both finite; `where` names the
  /// owner of the constants in the message.
  static NeoHookean from_young_poisson(double young, double poisson, const std::string& where);

  /// Any moduli, Pa, zero included: a derivative of the law by a constant is such a law.
  static NeoHookean from_moduli(double mu, double kappa) { return {mu, kappa}; }

  double mu() const { return mu_; }  ///< shear modulus, Pa

  /// Always: J^{-2/3} I1 is polyconvex, and strictly elliptic [Hartmann & Neff 2003].
  bool polyconvex() const { return true; }

  /// Isochoric energy density, J/m^3.
  template <class T>
  T psi(const Tensor2<T>& F, const T& J) const {
    return (0.5 * mu_) * (isochoric_scale(J) * double_contraction(F, F) - 3.0);
  }

  /// Isochoric first Piola-Kirchhoff stress: mu J^{-2/3} (F - (I1/3) F^-T), Pa.
  template <class T>
  Tensor2<T> piola(const Tensor2<T>& F, const Tensor2<T>& cof, const T& J) const {
    const T scale = mu_ * isochoric_scale(J);
    const T third = double_contraction(F, F) / (3.0 * J);
    Tensor2<T> P;
    for (std::size_t i = 0; i < 9; ++i) P[i] = scale * (F[i] - third * cof[i]);
    return P;
  }

  /// Isochoric dP/dF, Pa, with G = F^-T:
  ///   mu J^{-2/3} [ I - 2/3 (F x G + G x F) + 2/9 I1 G x G + I1/3 (G_iL G_kJ) ].
  template <class T>
  void add_tangent(const Tensor2<T>& F, const Tensor2<T>& cof, const T& J, Tensor4<T>& A) const {
    const T scale = mu_ * isochoric_scale(J);
    const T I1 = double_contraction(F, F);
    Tensor2<T> G;
    for (std::size_t i = 0; i < 9; ++i) G[i] = cof[i] / J;
    const T two_thirds = (2.0 / 3.0) * scale, two_ninths = (2.0 / 9.0) * scale * I1;
    const T third = scale * I1 / 3.0;
    for (std::size_t iJ = 0; iJ < 9; ++iJ)
      for (std::size_t kL = 0; kL < 9; ++kL) {
        A[iJ][kL] += two_ninths * G[iJ] * G[kL] - two_thirds * (F[iJ] * G[kL] + G[iJ] * F[kL]) +
                     third * G[3 * (iJ / 3) + kL % 3] * G[3 * (kL / 3) + iJ % 3];
        if (iJ == kL) A[iJ][kL] += scale;
      }
  }

 private:
  NeoHookean(double mu, double kappa) : LogQuadraticVolume(kappa), mu_(mu) {}
  double mu_;
};

}  // namespace palpate::fem
