// SPDX-License-Identifier: Apache-2.0
// The normal response of tissue that remembers how it was pressed.
#pragma once

#include "runtime/lanes.hpp"

namespace palpate::runtime {

/// The memories of all branches as one local model needs them, theory-runtime (R17)-(R19). With the
/// instantaneous response g = G' at the contact point, its conjugate energy
/// G*(F) = max over z of F z - G(z), and the forces F_i that the branches have relaxed:
///   F = sum g_i F_i,   K = sum g_i G*(F_i),   R = K - G*(F) >= 0.
/// In pairs: a processor passes on what it has just stored only to a load of the same width, and
/// copies load pairs. What the force depends on is not in one pair with energies, which take longer
/// to find.
struct NormalMemory {
  Pair relaxed_and_carried{0, 1};
  Pair stored_and_locked{};

  double relaxed() const noexcept { return relaxed_and_carried[0]; }  ///< F, N
  /// What a slide has left of the memories.
  double carried() const noexcept { return relaxed_and_carried[1]; }
  double stored() const noexcept { return stored_and_locked[0]; }  ///< K, J
  /// R, J: stored, but not within reach of the tool.
  double locked() const noexcept { return stored_and_locked[1]; }
};

/// Tissue without a memory at a depth.
struct InstantResponse {
  double depth = 0;   ///< z, m
  double force = 0;   ///< g(z), N
  double energy = 0;  ///< G(z), J
};

/// What a memory makes of the instantaneous normal response.
struct RelaxedResponse {
  InstantResponse instant;
  double scale = 1;   ///< psi = max(1 - F/g, 0); 0 where the skin lags behind the tool
  double force = 0;   ///< max(g - F, 0) = dV/dz, N
  double energy = 0;  ///< V = G - F z + K, or R where the skin lags, J
};

inline RelaxedResponse relaxed_response(const NormalMemory& memory,
                                        const InstantResponse& instant) noexcept {
  RelaxedResponse r{instant, 0, 0, memory.locked()};
  const double force = instant.force - memory.relaxed();
  if (!(force > 0)) return r;
  r.scale = force / instant.force;
  r.force = force;
  r.energy = instant.energy - memory.relaxed() * instant.depth + memory.stored();
  return r;
}

}  // namespace palpate::runtime
