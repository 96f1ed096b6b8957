// SPDX-License-Identifier: AGPL-3.0-or-later
// Tet10 with an element-constant pressure (mean dilatation [Simo, Taylor & Pister 1985],
// condensed):
//   Pi_e = sum_q w_q psi(F_q) + V U(Jbar),   Jbar = (1/V) sum_q w_q J_q,
// so that the stiffness stays symmetric and positive definite near nu = 1/2 without locking. Two
// variants: the pure displacement element, for comparison with other programs,
//   Pi_e = sum_q w_q (psi(F_q) + U(J_q)),
// and Pi_e = sum_q w_q psi(F_q), to which the mean dilatations around the corner nodes add their U
// (fem/solid/nodal_pressure.hpp). The linear element, Tet4, is the last variant with constant F, at
// one point and without mid-edge nodes.
#pragma once

#include "fem/laws/holzapfel_gasser_ogden.hpp"
#include "fem/laws/material.hpp"
#include "fem/mesh/tet10.hpp"
#include "fem/solid/dilatation.hpp"

namespace palpate::fem {

/// Geometry of one element, or of eight, in the reference configuration.
template <class T>
struct ElementGeometry {
  std::array<std::array<T, 3>, 4> gradient;  ///< dL_c/dX, 1/m
  T volume;                                  ///< m^3
  Fibres<T> fibres;                          ///< unit vectors, or zero
};

template <class T>
using ElementVector = std::array<std::array<T, 3>, kTetNodes>;

/// Lower triangle of the element stiffness, row >= column, degree of freedom 3 a + i.
template <class T>
using ElementMatrix = std::array<T, (3 * kTetNodes) * (3 * kTetNodes + 1) / 2>;

constexpr std::size_t lower_index(std::size_t row, std::size_t column) {
  return row * (row + 1) / 2 + column;
}

/// Kinematics at the Gauss points, shared by energy, forces and stiffness.
template <class T>
struct ElementKinematics {
  std::array<Tensor2<T>, kTetPoints> F, cof;
  std::array<T, kTetPoints> J;
  T mean_J;
};

/// The gradients of the volume coordinates times a factor.
template <class T, class Factor>
std::array<std::array<T, 3>, 4> scaled_gradient(const Factor& factor,
                                                const ElementGeometry<T>& geometry) {
  std::array<std::array<T, 3>, 4> scaled;
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t j = 0; j < 3; ++j) scaled[c][j] = factor * geometry.gradient[c][j];
  return scaled;
}

/// The part of F that all Gauss points have in common: see kTetStep.
template <class T>
Tensor2<T> common_deformation(const ElementGeometry<T>& geometry, const ElementVector<T>& u) {
  Tensor2<T> F;
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<T, 4> D;  // du_i/dL_c
    for (std::size_t c = 0; c < 4; ++c)
      D[c] = (4 * kTetFar - 1) * u[c][i] +
             4 * kTetFar *
                 (u[kTetBetween[c][(c + 1) % 4]][i] + u[kTetBetween[c][(c + 2) % 4]][i] +
                  u[kTetBetween[c][(c + 3) % 4]][i]);
    for (std::size_t j = 0; j < 3; ++j) {
      F[3 * i + j] = D[0] * geometry.gradient[0][j] + D[1] * geometry.gradient[1][j] +
                     D[2] * geometry.gradient[2][j] + D[3] * geometry.gradient[3][j];
      if (i == j) F[3 * i + j] += 1.0;
    }
  }
  return F;
}

template <class T>
ElementKinematics<T> kinematics(const ElementGeometry<T>& geometry, const ElementVector<T>& u) {
  ElementKinematics<T> k;
  const Tensor2<T> common = common_deformation(geometry, u);
  const auto step = scaled_gradient<T>(kTetStep, geometry);
  for (std::size_t q = 0; q < kTetPoints; ++q) {
    Tensor2<T>& F = k.F[q];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        F[3 * i + j] = common[3 * i + j] + u[kTetBetween[q][0]][i] * step[0][j] +
                       u[kTetBetween[q][1]][i] * step[1][j] + u[kTetBetween[q][2]][i] * step[2][j] +
                       u[kTetBetween[q][3]][i] * step[3][j];
    k.cof[q] = cofactor(F);
    k.J[q] = determinant(F, k.cof[q]);
  }
  k.mean_J = 0.25 * (k.J[0] + k.J[1] + k.J[2] + k.J[3]);
  return k;
}

/// Kinematics of the linear element, the same at every point.
template <class T>
ElementKinematics<T> linear_kinematics(const ElementGeometry<T>& geometry,
                                       const ElementVector<T>& u) {
  ElementKinematics<T> k;
  Tensor2<T>& F = k.F[0];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      F[3 * i + j] = u[0][i] * geometry.gradient[0][j];
      for (std::size_t c = 1; c < 4; ++c) F[3 * i + j] += u[c][i] * geometry.gradient[c][j];
      if (i == j) F[3 * i + j] += 1.0;
    }
  k.cof[0] = cofactor(F);
  k.J.fill(determinant(F, k.cof[0]));
  k.F.fill(Tensor2<T>(F));
  k.cof.fill(Tensor2<T>(k.cof[0]));
  k.mean_J = k.J[0];
  return k;
}

/// Number of integration points of the element, all of the same weight.
constexpr std::size_t points_of(Dilatation dilatation) {
  return is_linear(dilatation) ? 1 : kTetPoints;
}

/// Strain energy of the element, J; with nodal pressures its isochoric part.
template <class T, class Law>
T element_energy(const Law& law, Dilatation dilatation, const ElementGeometry<T>& geometry,
                 const ElementKinematics<T>& k) {
  T density = dilatation == Dilatation::Mean ? law.volumetric_energy(k.mean_J) : zero_of<T>();
  const std::size_t points = points_of(dilatation);
  for (std::size_t q = 0; q < points; ++q) {
    density += (1.0 / static_cast<double>(points)) * law.psi(k.F[q], k.J[q], geometry.fibres);
    if (dilatation == Dilatation::Pointwise) density += 0.25 * law.volumetric_energy(k.J[q]);
  }
  return geometry.volume * density;
}

/// dU/dJ at the Gauss points, Pa.
template <class T>
using PointPressures = std::array<T, kTetPoints>;

template <class T, class Law>
PointPressures<T> own_pressures(const Law& law, Dilatation dilatation,
                                const ElementKinematics<T>& k) {
  PointPressures<T> p;
  if (dilatation == Dilatation::Mean)
    p.fill(law.pressure(k.mean_J));
  else
    for (std::size_t q = 0; q < kTetPoints; ++q) p[q] = law.pressure(k.J[q]);
  return p;
}

/// Linear between the pressures of the corners.
template <class T>
PointPressures<T> interpolated_pressures(const std::array<T, 4>& corner) {
  PointPressures<T> p;
  const T sum = kTetFar * (corner[0] + corner[1] + corner[2] + corner[3]);
  for (std::size_t q = 0; q < kTetPoints; ++q) p[q] = sum + (kTetNear - kTetFar) * corner[q];
  return p;
}

/// The mean of the corner pressures, at the one point of the linear element.
template <class T>
PointPressures<T> mean_pressure(const std::array<T, 4>& corner) {
  PointPressures<T> p;
  p.fill(0.25 * (corner[0] + corner[1] + corner[2] + corner[3]));
  return p;
}

/// Nodal forces f_a = sum_c dN_a/dL_c (w P . dL_c/dX), accumulated over the Gauss points for a
/// stress P given at each of them.
template <class T, class Stress>
ElementVector<T> nodal_forces(const ElementGeometry<T>& geometry, Stress&& stress) {
  ElementVector<T> f;
  const auto gradient = scaled_gradient<T>(T(0.25 * geometry.volume), geometry);
  Tensor2<T> sum;
  for (std::size_t q = 0; q < kTetPoints; ++q) {
    const Tensor2<T> P = stress(q);
    for (std::size_t i = 0; i < 9; ++i) sum[i] = q == 0 ? P[i] : T(sum[i] + P[i]);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 4; ++c) {
        const T t = P[3 * i] * gradient[c][0] + P[3 * i + 1] * gradient[c][1] +
                    P[3 * i + 2] * gradient[c][2];
        T& force = f[kTetBetween[q][c]][i];
        force = c < q ? T(force + kTetStep * t) : T(kTetStep * t);
      }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<T, 4> t;  // of all points, with L = kTetFar
    for (std::size_t c = 0; c < 4; ++c) {
      t[c] = sum[3 * i] * gradient[c][0] + sum[3 * i + 1] * gradient[c][1] +
             sum[3 * i + 2] * gradient[c][2];
      f[c][i] += (4 * kTetFar - 1) * t[c];
    }
    for (std::size_t e = 0; e < kTetEdges.size(); ++e)
      f[4 + e][i] += (4 * kTetFar) * (t[kTetEdges[e][0]] + t[kTetEdges[e][1]]);
  }
  return f;
}

/// Nodal forces of the linear element with stress P: f_c = V P . dL_c/dX.
template <class T>
ElementVector<T> linear_forces(const ElementGeometry<T>& geometry, const Tensor2<T>& P) {
  ElementVector<T> f;
  for (auto& force : f) force.fill(zero_of<T>());
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t i = 0; i < 3; ++i)
      f[c][i] = geometry.volume *
                (P[3 * i] * geometry.gradient[c][0] + P[3 * i + 1] * geometry.gradient[c][1] +
                 P[3 * i + 2] * geometry.gradient[c][2]);
  return f;
}

/// Internal forces of the element, N: the derivative of its energy and, with nodal pressures, of
/// the energy of its corners.
template <class T, class Law>
ElementVector<T> element_forces(const Law& law, Dilatation dilatation,
                                const ElementGeometry<T>& geometry, const ElementKinematics<T>& k,
                                const PointPressures<T>& pressure) {
  const auto stress = [&](std::size_t q) {
    Tensor2<T> P = law.piola(k.F[q], k.cof[q], k.J[q], geometry.fibres);
    for (std::size_t i = 0; i < 9; ++i) P[i] += pressure[q] * k.cof[q][i];
    return P;
  };
  return is_linear(dilatation) ? linear_forces(geometry, stress(0))
                               : nodal_forces(geometry, stress);
}

/// d(integral of L_c det F over the element)/du.
template <class T>
ElementVector<T> dilatation_forces(Dilatation dilatation, const ElementGeometry<T>& geometry,
                                   const ElementKinematics<T>& k, std::size_t c) {
  const auto weighted_cofactor = [&](std::size_t q) {
    const double L = is_linear(dilatation) ? 0.25 : q == c ? kTetNear : kTetFar;
    Tensor2<T> cof = k.cof[q];
    for (T& entry : cof) entry *= L;
    return cof;
  };
  return is_linear(dilatation) ? linear_forces(geometry, weighted_cofactor(0))
                               : nodal_forces(geometry, weighted_cofactor);
}

/// Add p d(cof F)/dF, the geometric part of the pressure: with the permutation symbol e,
/// d cof_iJ / dF_kL = e_ikm e_JLN F_mN.
template <class T>
void add_cofactor_tangent(const Tensor2<T>& F, const T& p, Tensor4<T>& A) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      if (i == k) continue;
      const std::size_t m = 3 - i - k;
      const double sign_rows = (k + 3 - i) % 3 == 1 ? 1.0 : -1.0;
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t l = 0; l < 3; ++l) {
          if (j == l) continue;
          const std::size_t n = 3 - j - l;
          const double sign = sign_rows * ((l + 3 - j) % 3 == 1 ? 1.0 : -1.0);
          A[3 * i + j][3 * k + l] += sign * (p * F[3 * m + n]);
        }
    }
}

/// M_cd = dL_c/dX . A . dL_d/dX for the volume coordinates, M[c][d][3 i + k].
template <class T>
using CoordinateStiffness = std::array<std::array<std::array<T, 9>, 4>, 4>;

template <class T>
CoordinateStiffness<T> coordinate_stiffness(const T& weight, const ElementGeometry<T>& geometry,
                                            const Tensor4<T>& A) {
  CoordinateStiffness<T> M;
  for (std::size_t d = 0; d < 4; ++d) {
    const auto& g = geometry.gradient[d];
    std::array<std::array<T, 3>, 9> Ag;
    for (std::size_t iJ = 0; iJ < 9; ++iJ)
      for (std::size_t k = 0; k < 3; ++k)
        Ag[iJ][k] =
            weight * (A[iJ][3 * k] * g[0] + A[iJ][3 * k + 1] * g[1] + A[iJ][3 * k + 2] * g[2]);
    for (std::size_t c = 0; c < 4; ++c) {
      const auto& h = geometry.gradient[c];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          M[c][d][3 * i + k] =
              h[0] * Ag[3 * i][k] + h[1] * Ag[3 * i + 1][k] + h[2] * Ag[3 * i + 2][k];
    }
  }
  return M;
}

/// Add the stiffness of one Gauss point: K_ab = sum_cd dN_a/dL_c M_cd dN_b/dL_d.
template <class T>
void add_point_stiffness(std::size_t q, const CoordinateStiffness<T>& M, ElementMatrix<T>& K) {
  const auto& B = kTetShape[q];
  for (std::size_t a = 0; a < kTetNodes; ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      std::array<T, 9> block;
      bool first = true;
      for (std::size_t c = 0; c < 4; ++c) {
        if (B[a][c] == 0) continue;
        for (std::size_t d = 0; d < 4; ++d) {
          if (B[b][d] == 0) continue;
          const double scale = B[a][c] * B[b][d];
          for (std::size_t ik = 0; ik < 9; ++ik) {
            if (first)
              block[ik] = scale * M[c][d][ik];
            else
              block[ik] += scale * M[c][d][ik];
          }
          first = false;
        }
      }
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < (a == b ? i + 1 : 3); ++k)
          K[lower_index(3 * a + i, 3 * b + k)] += block[3 * i + k];
    }
}

/// The same where N_c = L_c.
template <class T>
void add_linear_stiffness(const CoordinateStiffness<T>& M, ElementMatrix<T>& K) {
  for (std::size_t row = 0; row < 12; ++row)
    for (std::size_t column = 0; column <= row; ++column)
      K[lower_index(row, column)] += M[row / 3][column / 3][3 * (row % 3) + column % 3];
}

/// Add U''(J) cof F x cof F, the pure displacement element's resistance to dilatation.
template <class T>
void add_dilatation_tangent(const Tensor2<T>& cof, const T& slope, Tensor4<T>& A) {
  for (std::size_t i = 0; i < 9; ++i) {
    const T scaled = slope * cof[i];
    for (std::size_t k = 0; k < 9; ++k) A[i][k] += scaled * cof[k];
  }
}

/// K = (U''/V) g g^T with g = d(V Jbar)/du: the stiffness of the condensed pressure.
template <class T, class Law>
void set_pressure_stiffness(const Law& law, const ElementGeometry<T>& geometry,
                            const ElementKinematics<T>& k, ElementMatrix<T>& K) {
  const ElementVector<T> g = nodal_forces(geometry, [&](std::size_t q) { return k.cof[q]; });
  const T rank_one = law.pressure_slope(k.mean_J) / geometry.volume;
  for (std::size_t row = 0; row < 3 * kTetNodes; ++row) {
    const T scaled = rank_one * g[row / 3][row % 3];
    for (std::size_t column = 0; column <= row; ++column)
      K[lower_index(row, column)] = scaled * g[column / 3][column % 3];
  }
}

/// Stiffness of the element, N/m: the derivative of element_forces; with nodal pressures the
/// derivative at constant pressures.
template <class T, class Law>
void element_stiffness(const Law& law, Dilatation dilatation, const ElementGeometry<T>& geometry,
                       const ElementKinematics<T>& k, const PointPressures<T>& pressure,
                       ElementMatrix<T>& K) {
  if (dilatation == Dilatation::Mean)
    set_pressure_stiffness(law, geometry, k, K);
  else
    K.fill(zero_of<T>());
  const std::size_t points = points_of(dilatation);
  const T weight = (1.0 / static_cast<double>(points)) * geometry.volume;
  for (std::size_t q = 0; q < points; ++q) {
    Tensor4<T> A;
    for (auto& row : A) row.fill(zero_of<T>());
    law.add_tangent(k.F[q], k.cof[q], k.J[q], geometry.fibres, A);
    add_cofactor_tangent(k.F[q], pressure[q], A);
    if (dilatation == Dilatation::Pointwise)
      add_dilatation_tangent(k.cof[q], T(law.pressure_slope(k.J[q])), A);
    const CoordinateStiffness<T> M = coordinate_stiffness(weight, geometry, A);
    if (is_linear(dilatation))
      add_linear_stiffness(M, K);
    else
      add_point_stiffness(q, M, K);
  }
}

}  // namespace palpate::fem
