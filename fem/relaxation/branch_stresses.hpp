// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "fem/solid/history_stress.hpp"
#include "format/relaxation.hpp"

namespace palpate::fem {

/// The internal variables of a body that relaxes, at the Gauss points [Simo 1987; Holzapfel 2000,
/// eqs. 6.252 and 6.273]. With the isochoric stress S at once after a step of strain,
///   S_iso = g_inf S + sum of Q_i,   dQ_i/dt + Q_i/tau_i = g_i dS/dt,
/// and, for a step of length h, by the midpoint rule, second-order in h and exact at h = 0 and for
/// a constant S:
///   Q_i' = exp(-h/tau_i) Q_i + g_i exp(-h/(2 tau_i)) (S' - S).
/// One thread.
class BranchStresses {
 public:
  /// A body without stress. `region`: of each element.
  BranchStresses(RegionRelaxation relaxation, std::vector<std::int32_t> region);

  /// The step of length `h`, s, that starts here: S_iso = c S' + H.
  HistoryStress step(double h) const;

  /// Moves on to the end of that step, where the isochoric stress at once is `S`.
  void advance(double h, const StressField& S);

 private:
  double fraction(std::size_t element, std::size_t branch) const;

  RegionRelaxation relaxation_;
  std::vector<std::int32_t> region_;
  StressField S_;               ///< at once, here
  std::vector<StressField> Q_;  ///< by branch
};

}  // namespace palpate::fem
