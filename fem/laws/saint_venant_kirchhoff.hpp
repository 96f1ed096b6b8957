// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fem/laws/invariant_law.hpp"

namespace palpate::fem {

/// Psi = lambda/2 (tr E)^2 + mu E:E, E = (C - 1)/2. For comparison with other programs: it softens
/// under compression and does not resist collapse. It has no split into a change of shape and one
/// of volume, so the element treats it as a pure displacement law, which locks towards nu = 1/2.
class SaintVenantKirchhoff {
 public:
  /// Lame's constants, Pa.
  SaintVenantKirchhoff(double lambda, double mu) : lambda_(lambda), mu_(mu) {}

  bool polyconvex() const { return false; }

  template <class T>
  T psi(const Tensor2<T>& F, const T&) const {
    const Tensor2<T> E = strain(F);
    const T trace = E[0] + E[4] + E[8];
    return (0.5 * lambda_) * trace * trace + mu_ * double_contraction(E, E);
  }

  /// P = F S, S = lambda tr(E) 1 + 2 mu E.
  template <class T>
  Tensor2<T> piola(const Tensor2<T>& F, const Tensor2<T>&, const T&) const {
    return product(F, second_piola(F));
  }

  /// delta_ik S_JL + lambda F_iJ F_kL + mu (B_ik delta_JL + F_iL F_kJ), B = F F^T.
  template <class T>
  void add_tangent(const Tensor2<T>& F, const Tensor2<T>&, const T&, Tensor4<T>& A) const {
    const Tensor2<T> S = second_piola(F), B = gram(transpose(F));
    for (std::size_t iJ = 0; iJ < 9; ++iJ)
      for (std::size_t kL = 0; kL < 9; ++kL) {
        const std::size_t i = iJ / 3, j = iJ % 3, k = kL / 3, l = kL % 3;
        A[iJ][kL] += lambda_ * F[iJ] * F[kL] + mu_ * F[3 * i + l] * F[3 * k + j];
        if (i == k) A[iJ][kL] += S[3 * j + l];
        if (j == l) A[iJ][kL] += mu_ * B[3 * i + k];
      }
  }

  /// All of the energy is in psi.
  template <class T>
  T volumetric_energy(const T&) const {
    return zero_of<T>();
  }
  template <class T>
  T pressure(const T&) const {
    return zero_of<T>();
  }
  template <class T>
  T pressure_slope(const T&) const {
    return zero_of<T>();
  }

 private:
  template <class T>
  static Tensor2<T> strain(const Tensor2<T>& F) {
    Tensor2<T> E = gram(F);
    for (std::size_t i = 0; i < 9; ++i) {
      E[i] = 0.5 * E[i];
      if (i % 4 == 0) E[i] -= 0.5;
    }
    return E;
  }
  template <class T>
  Tensor2<T> second_piola(const Tensor2<T>& F) const {
    Tensor2<T> S = strain(F);
    const T pressure = lambda_ * (S[0] + S[4] + S[8]);
    for (std::size_t i = 0; i < 9; ++i) {
      S[i] = 2 * mu_ * S[i];
      if (i % 4 == 0) S[i] += pressure;
    }
    return S;
  }

  double lambda_, mu_;
};

}  // namespace palpate::fem
