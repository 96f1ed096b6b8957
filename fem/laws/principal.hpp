// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fem/laws/material.hpp"

namespace palpate::fem {

/// Squares of the principal stretches and principal directions of C: C = sum l2_i N_i x N_i.
template <class T>
struct PrincipalStretches {
  std::array<T, 3> squared;
  std::array<std::array<T, 3>, 3> N;
};

/// By cyclic Jacobi rotations [Golub & Van Loan 2013, sec. 8.5], a fixed number of them, so that
/// eight elements go in step. Equal stretches are no special case: any orthonormal directions of
/// theirs serve. Six sweeps reach round-off for any F met in a solid.
template <class T>
PrincipalStretches<T> principal_stretches(Tensor2<T> C) {
  constexpr int kSweeps = 6;
  constexpr double kNoDivisionByZero = 1e-200;
  constexpr std::array<std::array<std::size_t, 3>, 3> pairs{{{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}};
  PrincipalStretches<T> result;
  auto& N = result.N;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) N[i][j] = constant_of<T>(i == j ? 1.0 : 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const auto& [p, q, r] : pairs) {
      const T a = C[3 * p + q], d = 0.5 * (C[3 * q + q] - C[3 * p + p]);
      const T sign = 2.0 * exceeds(d, 0.0) - 1.0;
      const T t = sign * a / (sign * d + square_root(T(d * d + a * a + kNoDivisionByZero)));
      const T c = 1.0 / square_root(T(t * t + 1.0)), s = t * c;
      C[3 * p + p] -= t * a;
      C[3 * q + q] += t * a;
      C[3 * p + q] = C[3 * q + p] = zero_of<T>();
      const T rp = C[3 * r + p], rq = C[3 * r + q];
      C[3 * r + p] = C[3 * p + r] = c * rp - s * rq;
      C[3 * r + q] = C[3 * q + r] = s * rp + c * rq;
      for (std::size_t i = 0; i < 3; ++i) {
        const T np = N[p][i], nq = N[q][i];
        N[p][i] = c * np - s * nq;
        N[q][i] = s * np + c * nq;
      }
    }
  result.squared = {C[0], C[4], C[8]};
  return result;
}

}  // namespace palpate::fem
