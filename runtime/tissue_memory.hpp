// SPDX-License-Identifier: Apache-2.0
// What the tissue under a contact remembers, as one local model needs it.
#pragma once

#include <cstdint>

#include "format/vec3.hpp"
#include "runtime/lanes.hpp"
#include "runtime/normal_memory.hpp"

namespace palpate::runtime {

/// The memories of all branches as one local model needs them, theory-runtime (R22), (R23). With
/// the instantaneous response grad H at the contact point, its conjugate energy H*, and the
/// tangential forces M_i that the branches have relaxed:
///   M = sum g_i M_i,   K = sum g_i H*(|M_i|),   V = H(|q|) - M . q + K,   f = grad H(|q|) - M.
/// In pairs, as NormalMemory.
struct LateralMemory {
  Pair relaxed_xy{};
  Pair relaxed_z{};
  Pair stored_and_carried{0, 1};
  double held = 1;          ///< what a contact that has shrunk has left of the forces M_i
  bool any = false;         ///< whether a branch may have relaxed a force
  std::uint64_t slide = 0;  ///< to another contact point than that of the branches; 0: none
  std::uint64_t grip = 0;   ///< other than that of the branches; 0: none

  Vec3 relaxed() const noexcept { return {relaxed_xy[0], relaxed_xy[1], relaxed_z[0]}; }  ///< M, N
  double stored() const noexcept { return stored_and_carried[0]; }                        ///< K, J
  /// What the slide there has left of their deflections.
  double carried() const noexcept { return stored_and_carried[1]; }
};

/// What presses and drags have left.
struct TissueMemory {
  NormalMemory normal;
  LateralMemory lateral;
};

}  // namespace palpate::runtime
