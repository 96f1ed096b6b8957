// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "fem/laws/invariant_law.hpp"
#include "fem/laws/principal.hpp"
#include "fem/laws/volumetric.hpp"

namespace palpate::fem {

/// A term of Ogden's law; C is the scalar of the constants.
template <class C = double>
struct OgdenTerm {
  C mu, alpha;  ///< Pa, pure
};

/// Principal Kirchhoff stresses tau_i of an isochoric deformation with the principal logarithmic
/// strains e_i, Pa, and their derivatives dtau_i/de_j.
template <class T>
struct PrincipalStresses {
  std::array<T, 3> tau;
  std::array<std::array<T, 3>, 3> slope;
};

/// tau_i = sum_p 2 mu_p/alpha_p (l_i^a - mean l^a), l_i = exp(e_i).
template <class C, class T>
PrincipalStresses<T> principal_stresses(const std::vector<OgdenTerm<C>>& terms,
                                        const std::array<T, 3>& strain) {
  PrincipalStresses<T> s;
  for (std::size_t i = 0; i < 3; ++i) {
    s.tau[i] = zero_of<T>();
    s.slope[i].fill(zero_of<T>());
  }
  for (const OgdenTerm<C>& term : terms) {
    std::array<T, 3> x;
    for (std::size_t i = 0; i < 3; ++i) x[i] = exponential(T(term.alpha * strain[i]));
    const T mean = (x[0] + x[1] + x[2]) / 3.0;
    for (std::size_t i = 0; i < 3; ++i) {
      s.tau[i] += (2.0 * term.mu / term.alpha) * (x[i] - mean);
      for (std::size_t j = 0; j < 3; ++j)
        s.slope[i][j] += (2.0 * term.mu / 3.0) * (mean - x[i] - x[j]);
      s.slope[i][i] += (2.0 * term.mu) * x[i];
    }
  }
  return s;
}

/// Psi = sum over terms of 2 mu_p/alpha_p^2 (l_1^a + l_2^a + l_3^a - 3) + U(J), in the isochoric
/// principal stretches l_i = J^{-1/3} lambda_i [Ogden 1972]. mu_p is the part of the term in the
/// shear modulus: mu = sum mu_p. Ogden's own constants are 2 mu_p/alpha_p.
class Ogden : public LogQuadraticVolume {
 public:
  using Term = OgdenTerm<>;

  Ogden(std::vector<Term> terms, double kappa)
      : LogQuadraticVolume(kappa), terms_(std::move(terms)) {}

  /// Terms of a positive modulus are polyconvex for alpha >= 3/2 and, by the stretches of areas,
  /// for alpha <= -3 [Hartmann & Neff 2003].
  bool polyconvex() const {
    return std::all_of(terms_.begin(), terms_.end(), [](const Term& term) {
      return term.mu > 0 && (term.alpha >= 1.5 || term.alpha <= -3);
    });
  }

  template <class T>
  T psi(const Tensor2<T>& F, const T& J) const {
    const auto strain = logarithmic_strains(principal_stretches(gram(F)), J);
    T sum = zero_of<T>();
    for (const Term& term : terms_) {
      T powers = constant_of<T>(-3.0);
      for (const T& e : strain) powers += exponential(T(term.alpha * e));
      sum += (2 * term.mu / (term.alpha * term.alpha)) * powers;
    }
    return sum;
  }

  /// P = F sum_i tau_i/lambda_i^2 N_i x N_i, with the principal Kirchhoff stresses
  /// tau_i = sum_p 2 mu_p/alpha_p (l_i^a - mean l^a).
  template <class T>
  Tensor2<T> piola(const Tensor2<T>& F, const Tensor2<T>&, const T& J) const {
    const PrincipalStretches<T> principal = principal_stretches(gram(F));
    const std::array<T, 3> tau = principal_stresses(terms_, logarithmic_strains(principal, J)).tau;
    Tensor2<T> S;
    for (T& entry : S) entry = zero_of<T>();
    for (std::size_t i = 0; i < 3; ++i) {
      const T scale = tau[i] / principal.squared[i];
      const auto& N = principal.N[i];
      for (std::size_t jk = 0; jk < 9; ++jk) S[jk] += scale * N[jk / 3] * N[jk % 3];
    }
    return product(F, S);
  }

  /// dP/dF in the principal frames n_i x N_j, n_i = F N_i/lambda_i [Ogden 1984, sec. 6.1.4], with
  /// h_ij = dP_i/dlambda_j of the principal stresses P_i:
  ///   sum h_ij (ii)(jj) + sum_{i<j} [ g/2 (ij + ji)(ij + ji) + f/2 (ij - ji)(ij - ji) ],
  ///   g = (P_i - P_j)/(lambda_i - lambda_j),   f = (P_i + P_j)/(lambda_i + lambda_j).
  template <class T>
  void add_tangent(const Tensor2<T>& F, const Tensor2<T>&, const T& J, Tensor4<T>& A) const {
    const PrincipalStretches<T> principal = principal_stretches(gram(F));
    const PrincipalStresses<T> s = principal_stresses(terms_, logarithmic_strains(principal, J));
    std::array<T, 3> lambda, P;
    std::array<std::array<T, 3>, 3> n;
    for (std::size_t i = 0; i < 3; ++i) {
      lambda[i] = square_root(principal.squared[i]);
      P[i] = s.tau[i] / lambda[i];
      for (std::size_t k = 0; k < 3; ++k)
        n[i][k] = (F[3 * k] * principal.N[i][0] + F[3 * k + 1] * principal.N[i][1] +
                   F[3 * k + 2] * principal.N[i][2]) /
                  lambda[i];
    }
    std::array<Tensor2<T>, 9> frame;
    for (std::size_t ij = 0; ij < 9; ++ij)
      for (std::size_t kl = 0; kl < 9; ++kl)
        frame[ij][kl] = n[ij / 3][kl / 3] * principal.N[ij % 3][kl % 3];
    std::array<std::array<T, 3>, 3> h;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        h[i][j] = s.slope[i][j] / (lambda[i] * lambda[j]);
        if (i == j) h[i][j] -= s.tau[i] / (lambda[i] * lambda[i]);
      }
    for (std::size_t i = 0; i < 3; ++i) {
      Tensor2<T> row;
      for (std::size_t kl = 0; kl < 9; ++kl)
        row[kl] = h[i][0] * frame[0][kl] + h[i][1] * frame[4][kl] + h[i][2] * frame[8][kl];
      add_product(constant_of<T>(1.0), frame[4 * i], row, A);
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i + 1; j < 3; ++j) {
        const T stretch = divided_difference(P[i], P[j], lambda[i], lambda[j],
                                             T(0.5 * (h[i][i] + h[j][j]) - h[i][j]));
        const T turn = (P[i] + P[j]) / (lambda[i] + lambda[j]);
        Tensor2<T> plus, minus;
        for (std::size_t kl = 0; kl < 9; ++kl) {
          plus[kl] = frame[3 * i + j][kl] + frame[3 * j + i][kl];
          minus[kl] = frame[3 * i + j][kl] - frame[3 * j + i][kl];
        }
        add_product(T(0.5 * stretch), plus, plus, A);
        add_product(T(0.5 * turn), minus, minus, A);
      }
  }

 private:
  /// ln(J^{-1/3} lambda_i).
  template <class T>
  static std::array<T, 3> logarithmic_strains(const PrincipalStretches<T>& principal, const T& J) {
    const T mean = logarithm(J) / 3.0;
    std::array<T, 3> strain;
    for (std::size_t i = 0; i < 3; ++i) strain[i] = 0.5 * logarithm(principal.squared[i]) - mean;
    return strain;
  }

  /// (a - b)/(x - y), or its `limit` where x and y agree to five digits: there the difference has
  /// lost half its digits, and the limit is as good.
  template <class T>
  static T divided_difference(const T& a, const T& b, const T& x, const T& y, const T& limit) {
    const T d = x - y;
    const T apart = exceeds(T(d * d / (x * y)), 1e-10);
    return apart * ((a - b) / (d + (1.0 - apart))) + (1.0 - apart) * limit;
  }

  template <class T>
  static void add_product(const T& scale, const Tensor2<T>& a, const Tensor2<T>& b, Tensor4<T>& A) {
    for (std::size_t i = 0; i < 9; ++i) {
      const T scaled = scale * a[i];
      for (std::size_t k = 0; k < 9; ++k) A[i][k] += scaled * b[k];
    }
  }

  std::vector<Term> terms_;
};

}  // namespace palpate::fem
