// SPDX-License-Identifier: Apache-2.0
// The lateral response of tissue that remembers how it was dragged.
#pragma once

#include "format/vec3.hpp"

namespace palpate::runtime {

/// The memories of all branches as one local model needs them, theory-runtime (R22)-(R25). With the
/// instantaneous response grad H at the contact point, its conjugate energy H*, and the tangential
/// forces M_i that the branches have relaxed:
///   M = sum g_i M_i,   K = sum g_i H*(|M_i|),   V = H(|q|) - M . q + K,   f = grad H(|q|) - M.
struct LateralMemory {
  bool any = false;    ///< whether a branch may have relaxed a force
  Vec3 relaxed{};      ///< M, N
  double stored = 0;   ///< K, J
  bool moved = false;  ///< to another contact point than that of the branches
  double carried = 1;  ///< what the slide there has left of their deflections
};

}  // namespace palpate::runtime
