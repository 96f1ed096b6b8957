// SPDX-License-Identifier: Apache-2.0
// What the tissue under a contact remembers, as one local model needs it.
#pragma once

#include <cstdint>

#include "format/vec3.hpp"
#include "runtime/normal_memory.hpp"

namespace palpate::runtime {

/// The memories of all branches as one local model needs them, theory-runtime (R22), (R23). With
/// the instantaneous response grad H at the contact point, its conjugate energy H*, and the
/// tangential forces M_i that the branches have relaxed:
///   M = sum g_i M_i,   K = sum g_i H*(|M_i|),   V = H(|q|) - M . q + K,   f = grad H(|q|) - M.
struct LateralMemory {
  bool any = false;         ///< whether a branch may have relaxed a force
  Vec3 relaxed{};           ///< M, N
  double stored = 0;        ///< K, J
  std::uint64_t slide = 0;  ///< to another contact point than that of the branches; 0: none
  double carried = 1;       ///< what the slide there has left of their deflections
};

/// What presses and drags have left.
struct TissueMemory {
  NormalMemory normal;
  LateralMemory lateral;
};

}  // namespace palpate::runtime
