// SPDX-License-Identifier: AGPL-3.0-or-later
// Laws in the isochoric invariants of C: Psi = W(x, y) + U(J),
//   x = J^{-2/3} I1 - 3,   y = J^{-4/3} I2 - 3,   I2 = (I1^2 - C:C)/2,
// with the volumetric penalty of volumetric.hpp. A law gives W and its derivatives; the stress and
// the tangent are made here, once.
#pragma once

#include <array>

#include "fem/laws/material.hpp"
#include "fem/laws/volumetric.hpp"

namespace palpate::fem {

/// Derivatives of W(x, y).
template <class T>
struct InvariantSlopes {
  T W1, W2, W11, W12, W22;
};

/// x, y and what their derivatives by F are made of, G = F^-T.
template <class T>
struct IsochoricInvariants {
  Tensor2<T> G, D1, D2;  ///< D1 = dx/dF, D2 = dy/dF
  Tensor2<T> dI2;        ///< dI2/dF = 2 (I1 F - F C)
  T I1, I2, scale1, scale2;
  T x, y;
};

/// M^T M.
template <class T>
Tensor2<T> gram(const Tensor2<T>& M) {
  Tensor2<T> C;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j)
      C[3 * i + j] = C[3 * j + i] = M[i] * M[j] + M[3 + i] * M[3 + j] + M[6 + i] * M[6 + j];
  return C;
}

template <class T>
Tensor2<T> product(const Tensor2<T>& a, const Tensor2<T>& b) {
  Tensor2<T> c;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
  return c;
}

template <class T>
Tensor2<T> transpose(const Tensor2<T>& a) {
  return {a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]};
}

/// A += scale d2(J^{-2/3} F:FH)/dF2 for a symmetric H, with M = F H and I = F:M:
///   2 J^{-2/3} [ delta_ik H_JL - 2/3 (M x G + G x M) + 2/9 I G x G + I/3 G_iL G_kJ ].
/// H = 1 gives the first invariant. `scale` includes the J^{-2/3}.
template <class T>
void add_quadratic_tangent(const T& scale, const Tensor2<T>& H, const Tensor2<T>& M, const T& I,
                           const Tensor2<T>& G, Tensor4<T>& A) {
  const T two = 2.0 * scale, four_thirds = (4.0 / 3.0) * scale;
  const T four_ninths = (4.0 / 9.0) * scale * I, two_thirds = (2.0 / 3.0) * scale * I;
  for (std::size_t iJ = 0; iJ < 9; ++iJ)
    for (std::size_t kL = 0; kL < 9; ++kL) {
      A[iJ][kL] += four_ninths * G[iJ] * G[kL] - four_thirds * (M[iJ] * G[kL] + G[iJ] * M[kL]) +
                   two_thirds * G[3 * (iJ / 3) + kL % 3] * G[3 * (kL / 3) + iJ % 3];
      if (iJ / 3 == kL / 3) A[iJ][kL] += two * H[3 * (iJ % 3) + kL % 3];
    }
}

template <class T>
Tensor2<T> identity() {
  Tensor2<T> one;
  for (std::size_t i = 0; i < 9; ++i) one[i] = constant_of<T>(i % 4 == 0 ? 1.0 : 0.0);
  return one;
}

/// `Energy` has value(x, y), slopes(x, y) and kSecond, whether it depends on y.
template <class Energy>
class InvariantLaw : public LogQuadraticVolume {
 public:
  /// `kappa`: bulk modulus, Pa.
  InvariantLaw(Energy energy, double kappa) : LogQuadraticVolume(kappa), energy_(energy) {}

  /// Whether the constants are known to make the energy polyconvex [Hartmann & Neff 2003]: powers
  /// of x with coefficients that are not negative do; y is not polyconvex.
  bool polyconvex() const { return energy_.polyconvex(); }

  /// Isochoric energy density, J/m^3.
  template <class T>
  T psi(const Tensor2<T>& F, const T& J) const {
    const T scale = isochoric_scale(J), I1 = double_contraction(F, F);
    const T x = scale * I1 - 3.0;
    if constexpr (!Energy::kSecond) {
      return energy_.value(x, x);
    } else {
      const Tensor2<T> C = gram(F);
      const T y = 0.5 * scale * scale * (I1 * I1 - double_contraction(C, C)) - 3.0;
      return energy_.value(x, y);
    }
  }

  /// Isochoric first Piola-Kirchhoff stress W1 dx/dF + W2 dy/dF, Pa.
  template <class T>
  Tensor2<T> piola(const Tensor2<T>& F, const Tensor2<T>& cof, const T& J) const {
    const IsochoricInvariants<T> v = invariants(F, cof, J);
    const InvariantSlopes<T> W = energy_.slopes(v.x, v.y);
    Tensor2<T> P;
    for (std::size_t i = 0; i < 9; ++i) {
      P[i] = W.W1 * v.D1[i];
      if constexpr (Energy::kSecond) P[i] += W.W2 * v.D2[i];
    }
    return P;
  }

  /// Isochoric dP/dF, Pa:
  ///   W1 d2x + W2 d2y + W11 dx x dx + W12 (dx x dy + dy x dx) + W22 dy x dy.
  template <class T>
  void add_tangent(const Tensor2<T>& F, const Tensor2<T>& cof, const T& J, Tensor4<T>& A) const {
    const IsochoricInvariants<T> v = invariants(F, cof, J);
    const InvariantSlopes<T> W = energy_.slopes(v.x, v.y);
    add_quadratic_tangent(T(W.W1 * v.scale1), identity<T>(), F, v.I1, v.G, A);
    for (std::size_t iJ = 0; iJ < 9; ++iJ) {
      T by_x = W.W11 * v.D1[iJ], by_y = zero_of<T>();
      if constexpr (Energy::kSecond) {
        by_x += W.W12 * v.D2[iJ];
        by_y = W.W12 * v.D1[iJ] + W.W22 * v.D2[iJ];
      }
      for (std::size_t kL = 0; kL < 9; ++kL) {
        A[iJ][kL] += by_x * v.D1[kL];
        if constexpr (Energy::kSecond) A[iJ][kL] += by_y * v.D2[kL];
      }
    }
    if constexpr (Energy::kSecond) add_second_tangent(T(W.W2 * v.scale2), F, v, A);
  }

 private:
  template <class T>
  static IsochoricInvariants<T> invariants(const Tensor2<T>& F, const Tensor2<T>& cof, const T& J) {
    IsochoricInvariants<T> v;
    v.scale1 = isochoric_scale(J);
    v.I1 = double_contraction(F, F);
    v.x = v.scale1 * v.I1 - 3.0;
    for (std::size_t i = 0; i < 9; ++i) {
      v.G[i] = cof[i] / J;
      v.D1[i] = 2.0 * v.scale1 * (F[i] - v.I1 / 3.0 * v.G[i]);
    }
    v.y = v.x;
    if constexpr (Energy::kSecond) {
      const Tensor2<T> C = gram(F), FC = product(F, C);
      v.I2 = 0.5 * (v.I1 * v.I1 - double_contraction(C, C));
      v.scale2 = v.scale1 * v.scale1;
      v.y = v.scale2 * v.I2 - 3.0;
      for (std::size_t i = 0; i < 9; ++i) {
        v.dI2[i] = 2.0 * (v.I1 * F[i] - FC[i]);
        v.D2[i] = v.scale2 * (v.dI2[i] - 4.0 / 3.0 * v.I2 * v.G[i]);
      }
    }
    return v;
  }

  /// A += scale J^{4/3} d2y/dF2, with B = F F^T:
  ///   d2I2 = 2 (2 F x F + I1 delta_ik delta_JL - delta_ik C_JL - F_iL F_kJ - B_ik delta_JL),
  ///   d2y = J^{-4/3} [ d2I2 - 4/3 (G x dI2 + dI2 x G) + 16/9 I2 G x G + 4/3 I2 G_iL G_kJ ].
  template <class T>
  static void add_second_tangent(const T& scale, const Tensor2<T>& F,
                                 const IsochoricInvariants<T>& v, Tensor4<T>& A) {
    const Tensor2<T> C = gram(F), B = gram(transpose(F));
    for (std::size_t iJ = 0; iJ < 9; ++iJ)
      for (std::size_t kL = 0; kL < 9; ++kL) {
        const std::size_t i = iJ / 3, j = iJ % 3, k = kL / 3, l = kL % 3;
        T sum = 4.0 * F[iJ] * F[kL] - 2.0 * F[3 * i + l] * F[3 * k + j];
        if (i == k) sum -= 2.0 * C[3 * j + l];
        if (j == l) sum -= 2.0 * B[3 * i + k];
        if (iJ == kL) sum += 2.0 * v.I1;
        sum -= 4.0 / 3.0 * (v.G[iJ] * v.dI2[kL] + v.dI2[iJ] * v.G[kL]);
        sum +=
            v.I2 * (16.0 / 9.0 * v.G[iJ] * v.G[kL] + 4.0 / 3.0 * v.G[3 * i + l] * v.G[3 * k + j]);
        A[iJ][kL] += scale * sum;
      }
  }

  Energy energy_;
};

}  // namespace palpate::fem
