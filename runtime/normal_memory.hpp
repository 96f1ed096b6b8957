// SPDX-License-Identifier: Apache-2.0
// The normal response of tissue that remembers how it was pressed.
#pragma once

namespace palpate::runtime {

/// The memories of all branches as one local model needs them, theory-runtime (R17)-(R19). With the
/// instantaneous response g = G' at the contact point, its conjugate energy
/// G*(F) = max over z of F z - G(z), and the forces F_i that the branches have relaxed:
///   F = sum g_i F_i,   K = sum g_i G*(F_i),   R = K - G*(F) >= 0.
struct NormalMemory {
  double relaxed = 0;  ///< F, N
  double stored = 0;   ///< K, J
  double locked = 0;   ///< R, J: stored, but not within reach of the tool
  double carried = 1;  ///< what a slide has left of the memories
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
  RelaxedResponse r{instant, 0, 0, memory.locked};
  const double force = instant.force - memory.relaxed;
  if (!(force > 0)) return r;
  r.scale = force / instant.force;
  r.force = force;
  r.energy = instant.energy - memory.relaxed * instant.depth + memory.stored;
  return r;
}

}  // namespace palpate::runtime
