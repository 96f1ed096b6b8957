// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fem/laws/law.hpp"

namespace palpate::fem {

/// A law with its isochoric energy times a factor: Psi = factor Psi_iso + U.
struct ScaledIsochoric {
  const Law& law;
  double factor;

  Lanes psi(const Tensor2<Lanes>& F, const Lanes& J, const Fibres<Lanes>& a) const {
    return factor * law.psi(F, J, a);
  }
  Tensor2<Lanes> piola(const Tensor2<Lanes>& F, const Tensor2<Lanes>& cof, const Lanes& J,
                       const Fibres<Lanes>& a) const {
    Tensor2<Lanes> P = law.piola(F, cof, J, a);
    for (Lanes& entry : P) entry *= factor;
    return P;
  }
  void add_tangent(const Tensor2<Lanes>& F, const Tensor2<Lanes>& cof, const Lanes& J,
                   const Fibres<Lanes>& a, Tensor4<Lanes>& A) const {
    Tensor4<Lanes> own;
    for (auto& row : own) row.fill(Lanes::Zero());
    law.add_tangent(F, cof, J, a, own);
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t k = 0; k < 9; ++k) A[i][k] += factor * own[i][k];
  }

  Lanes volumetric_energy(const Lanes& J) const { return law.volumetric_energy(J); }
  Lanes pressure(const Lanes& J) const { return law.pressure(J); }
  Lanes pressure_slope(const Lanes& J) const { return law.pressure_slope(J); }
};

}  // namespace palpate::fem
