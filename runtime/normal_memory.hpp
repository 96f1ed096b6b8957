// SPDX-License-Identifier: Apache-2.0
// The normal response of tissue that remembers how it was pressed.
#pragma once

#include <cmath>

namespace palpate::runtime {

/// The memories of all branches as one local model needs them, theory-runtime (R17)-(R19). With the
/// coordinate y = sqrt(2 G(z)) of the normal response and the memories a_i:
///   A = sum g_i a_i,   R = (sum g_i a_i^2 - A^2)/2 >= 0,   V = max(y - A, 0)^2/2 + R.
struct NormalMemory {
  double relaxed = 0;  ///< A, sqrt(J)
  double locked = 0;   ///< R, J: stored, but not within reach of the tool
  double carried = 1;  ///< what a slide has left of the memories
};

/// What a memory makes of the instantaneous normal response.
struct RelaxedResponse {
  double coordinate = 0;     ///< y, sqrt(J)
  double instantaneous = 0;  ///< g, N, of tissue without a memory
  double scale = 1;          ///< psi = max(1 - A/y, 0); 0 where the skin lags behind the tool
  double force = 0;          ///< psi g = dV/dz, N
  double energy = 0;         ///< V, J
};

/// The instantaneous response has the coordinate y = sqrt(2 G) and the force g (N).
inline RelaxedResponse relaxed_response(const NormalMemory& memory, double y, double g) noexcept {
  RelaxedResponse r{y, g, 0, 0, memory.locked};
  const double stretch = r.coordinate - memory.relaxed;
  if (!(stretch > 0)) return r;
  r.scale = stretch / r.coordinate;
  r.force = r.scale * g;
  r.energy += stretch * stretch / 2;
  return r;
}

}  // namespace palpate::runtime
