// SPDX-License-Identifier: AGPL-3.0-or-later
// A step of a body that relaxes, as an elastic one with a stress of its history. With the isochoric
// stress S = 2 dPsi_iso/dC at once after a step of strain, the recurrence of a Prony series
// [Simo 1987; Holzapfel 2000, sec. 6.10] makes the stress at the end of a step
//   S_iso = c S(F) + H,   H constant in the step,
// which is that of the energy c Psi_iso(F) + H:(C - 1)/2. So a step is a minimum like that of an
// elastic body, and its stiffness, the algorithmic tangent, is symmetric.
#pragma once

#include <vector>

#include "fem/laws/invariant_law.hpp"
#include "fem/laws/law.hpp"
#include "fem/solid/element.hpp"

namespace palpate::fem {

/// A symmetric second Piola-Kirchhoff stress, Pa: S_11, S_22, S_33, S_12, S_13, S_23.
using Stress = std::array<double, 6>;
/// At the Gauss points of each element of the mesh.
using StressField = std::vector<std::array<Stress, kTetPoints>>;

/// The data of a step: see above.
struct HistoryStress {
  std::vector<double> factor;  ///< c, by region
  StressField stress;          ///< H
};

/// H at one Gauss point of eight elements, row-major.
using PointHistory = Tensor2<Lanes>;
using ElementHistory = std::array<PointHistory, kTetPoints>;

/// Row-major index of the entries of a Stress.
inline constexpr std::array<std::size_t, 6> kStressEntries{0, 4, 8, 1, 2, 5};

inline ElementHistory gather(const StressField& field, const std::array<int, kLanes>& elements) {
  ElementHistory H;
  for (std::size_t q = 0; q < kTetPoints; ++q)
    for (std::size_t entry = 0; entry < 6; ++entry) {
      Lanes& value = H[q][kStressEntries[entry]];
      for (int lane = 0; lane < kLanes; ++lane)
        value[lane] =
            field[static_cast<std::size_t>(elements[static_cast<std::size_t>(lane)])][q][entry];
    }
  for (PointHistory& h : H) {
    h[3] = h[1];
    h[6] = h[2];
    h[7] = h[5];
  }
  return H;
}

/// Integral of H:(C - 1)/2 over the element, J.
inline Lanes history_energy(Dilatation dilatation, const ElementGeometry<Lanes>& geometry,
                            const ElementKinematics<Lanes>& k, const ElementHistory& H) {
  const std::size_t points = points_of(dilatation);
  Lanes sum = Lanes::Zero();
  for (std::size_t q = 0; q < points; ++q)
    sum += double_contraction(H[q], gram(k.F[q])) - (H[q][0] + H[q][4] + H[q][8]);
  return (0.5 / static_cast<double>(points)) * geometry.volume * sum;
}

/// Its derivative, N: the forces of the stress P = F H.
inline ElementVector<Lanes> history_forces(Dilatation dilatation,
                                           const ElementGeometry<Lanes>& geometry,
                                           const ElementKinematics<Lanes>& k,
                                           const ElementHistory& H) {
  const auto stress = [&](std::size_t q) { return product(k.F[q], H[q]); };
  return is_linear(dilatation) ? linear_forces(geometry, stress(0))
                               : nodal_forces(geometry, stress);
}

/// Adds its second derivative, N/m: that of dP/dF = delta_ik H_JL.
inline void add_history_stiffness(Dilatation dilatation, const ElementGeometry<Lanes>& geometry,
                                  const ElementHistory& H, ElementMatrix<Lanes>& K) {
  const std::size_t points = points_of(dilatation);
  const Lanes weight = geometry.volume / static_cast<double>(points);
  for (std::size_t q = 0; q < points; ++q) {
    Tensor4<Lanes> A;
    for (auto& row : A) row.fill(Lanes::Zero());
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t J = 0; J < 3; ++J)
        for (std::size_t L = 0; L < 3; ++L) A[3 * i + J][3 * i + L] = H[q][3 * J + L];
    const CoordinateStiffness<Lanes> M = coordinate_stiffness(weight, geometry, A);
    if (is_linear(dilatation))
      add_linear_stiffness(M, K);
    else
      add_point_stiffness(q, M, K);
  }
}

/// S = F^-1 P of the isochoric stress of a law at the Gauss points of eight elements.
inline std::array<Tensor2<Lanes>, kTetPoints> isochoric_stresses(
    const Law& law, const ElementGeometry<Lanes>& geometry, const ElementKinematics<Lanes>& k) {
  std::array<Tensor2<Lanes>, kTetPoints> S;
  for (std::size_t q = 0; q < kTetPoints; ++q) {
    const Tensor2<Lanes> P = law.piola(k.F[q], k.cof[q], k.J[q], geometry.fibres);
    S[q] = product(transpose(k.cof[q]), P);
    for (Lanes& entry : S[q]) entry /= k.J[q];
  }
  return S;
}

}  // namespace palpate::fem
