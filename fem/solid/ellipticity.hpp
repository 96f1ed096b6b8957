// SPDX-License-Identifier: AGPL-3.0-or-later
// Strong ellipticity of a law in a state of strain: with A = dP/dF the acoustic tensor
//   Q_ik(n) = A_iJkL n_J n_L
// is positive definite for every direction n. Where it is not, strong ellipticity is lost: strain
// may localize in bands as thin as the elements [Knowles & Sternberg 1977; Ogden 1984, sec. 6.2.7].
#pragma once

#include "fem/laws/material.hpp"

namespace palpate::fem {

/// The smallest eigenvalue of Q(n) over all unit n, Pa: min of A_iJkL m_i n_J m_k n_L over unit m
/// and n. A pressure times dcof F/dF does not change it and may be left out of A. Found by
/// alternating minimization over m and n, each step an eigenvalue problem, from directions spread
/// over the half sphere.
double min_acoustic_eigenvalue(const Tensor4<double>& A);

/// The same for eight points, or a positive lower value where a sufficient condition shows that it
/// is positive: A plus a multiple of dcof F/dF is positive definite.
Lanes min_acoustic_eigenvalue(const Tensor2<Lanes>& F, const Tensor4<Lanes>& A);

}  // namespace palpate::fem
