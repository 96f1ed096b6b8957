// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fem/laws/fibre_field.hpp"
#include "fem/laws/invariant_law.hpp"
#include "fem/laws/volumetric.hpp"

namespace palpate::fem {

/// Directions at rest of up to two families of fibres.
template <class T>
using Fibres = std::array<std::array<T, 3>, 2>;

/// Fibres in a neo-Hookean matrix [Gasser, Ogden & Holzapfel 2006; without dispersion Holzapfel,
/// Gasser & Ogden 2000]:
///   Psi = c/2 (J^{-2/3} I1 - 3) + sum over families of k1/(2 k2) (exp(k2 <E>^2) - 1) + U(J),
///   E = J^{-2/3} (kappa I1 + (1 - 3 kappa) a . C a) - 1 = J^{-2/3} C:H - 1,
///   H = kappa 1 + (1 - 3 kappa) a x a,   <E> = max(E, 0):
/// a family carries no load where its mean strain E is not positive (tension switch). The energy
/// has continuous stresses; the tangent jumps by the stiffness of the fibres at E = 0.
class HolzapfelGasserOgden : public LogQuadraticVolume {
 public:
  struct Constants {
    double c;           ///< shear modulus of the matrix, Pa
    double k1;          ///< stiffness of the fibres, Pa
    double k2;          ///< growth of that stiffness with strain
    double dispersion;  ///< kappa: 0 all along the direction .. 1/3 isotropic
  };

  HolzapfelGasserOgden(const Constants& constants, const FibreField& fibres, double kappa)
      : LogQuadraticVolume(kappa), k_(constants), field_(fibres) {}

  const FibreField& fibres() const { return field_; }

  /// Always, for J^{-2/3} I4 is polyconvex as J^{-2/3} I1 is, and a family carries no compression
  /// [Schroeder & Neff 2003].
  bool polyconvex() const { return true; }

  template <class T>
  T psi(const Tensor2<T>& F, const T& J, const Fibres<T>& a) const {
    const T scale = isochoric_scale(J);
    T sum = (0.5 * k_.c) * (scale * double_contraction(F, F) - 3.0);
    for (int family = 0; family < field_.families; ++family) {
      const Tensor2<T> M = product(F, structure(a[static_cast<std::size_t>(family)]));
      const T E = scale * double_contraction(F, M) - 1.0;
      const T taut = exceeds(E, kSlack) * E;
      sum += (0.5 * k_.k1 / k_.k2) * (exponential(T(k_.k2 * taut * taut)) - 1.0);
    }
    return sum;
  }

  /// c/2 dI1bar/dF + sum k1 <E> exp(k2 <E>^2) dE/dF.
  template <class T>
  Tensor2<T> piola(const Tensor2<T>& F, const Tensor2<T>& cof, const T& J,
                   const Fibres<T>& a) const {
    const T scale = isochoric_scale(J);
    Tensor2<T> P = slope(F, T(double_contraction(F, F)), cof, J);
    for (T& entry : P) entry = (0.5 * k_.c) * scale * entry;
    for (int family = 0; family < field_.families; ++family) {
      const Tensor2<T> M = product(F, structure(a[static_cast<std::size_t>(family)]));
      const T I = double_contraction(F, M);
      const T stress = scale * fibre(T(scale * I - 1.0)).first;
      const Tensor2<T> dE = slope(M, I, cof, J);
      for (std::size_t i = 0; i < 9; ++i) P[i] += stress * dE[i];
    }
    return P;
  }

  /// c/2 d2I1bar + sum [ psi' d2E + psi'' dE x dE ], psi'' = k1 (1 + 2 k2 E^2) exp(k2 E^2).
  template <class T>
  void add_tangent(const Tensor2<T>& F, const Tensor2<T>& cof, const T& J, const Fibres<T>& a,
                   Tensor4<T>& A) const {
    const T scale = isochoric_scale(J);
    Tensor2<T> G;
    for (std::size_t i = 0; i < 9; ++i) G[i] = cof[i] / J;
    add_quadratic_tangent(T((0.5 * k_.c) * scale), identity<T>(), F, T(double_contraction(F, F)), G,
                          A);
    for (int family = 0; family < field_.families; ++family) {
      const Tensor2<T> H = structure(a[static_cast<std::size_t>(family)]), M = product(F, H);
      const T I = double_contraction(F, M);
      const auto [stress, stiffness] = fibre(T(scale * I - 1.0));
      add_quadratic_tangent(T(stress * scale), H, M, I, G, A);
      const Tensor2<T> dE = slope(M, I, cof, J);
      const T factor = stiffness * scale * scale;
      for (std::size_t iJ = 0; iJ < 9; ++iJ) {
        const T scaled = factor * dE[iJ];
        for (std::size_t kL = 0; kL < 9; ++kL) A[iJ][kL] += scaled * dE[kL];
      }
    }
  }

 private:
  /// Strains below this are round-off of a body at rest.
  static constexpr double kSlack = 1e-13;

  template <class T>
  Tensor2<T> structure(const std::array<T, 3>& a) const {
    Tensor2<T> H;
    for (std::size_t i = 0; i < 9; ++i) {
      H[i] = (1 - 3 * k_.dispersion) * a[i / 3] * a[i % 3];
      if (i % 4 == 0) H[i] += k_.dispersion;
    }
    return H;
  }

  /// J^{2/3} d(J^{-2/3} F:M)/dF = 2 (M - I/3 F^-T) for M = F H, I = F:M.
  template <class T>
  static Tensor2<T> slope(const Tensor2<T>& M, const T& I, const Tensor2<T>& cof, const T& J) {
    const T third = I / (3.0 * J);
    Tensor2<T> D;
    for (std::size_t i = 0; i < 9; ++i) D[i] = 2.0 * (M[i] - third * cof[i]);
    return D;
  }

  /// First and second derivative of the energy of a family by E.
  template <class T>
  std::pair<T, T> fibre(const T& E) const {
    const T taut = exceeds(E, kSlack);
    const T square = taut * E * E;
    const T growth = k_.k1 * taut * exponential(T(k_.k2 * square));
    return {T(growth * E), T(growth * (1.0 + 2 * k_.k2 * square))};
  }

  Constants k_;
  FibreField field_;
};

}  // namespace palpate::fem
