// SPDX-License-Identifier: Apache-2.0
// What the tissue under a contact remembers.
#pragma once

#include "runtime/lateral_memory.hpp"
#include "runtime/normal_memory.hpp"

namespace palpate::runtime {

struct TissueMemory {
  NormalMemory normal;
  LateralMemory lateral;
};

}  // namespace palpate::runtime
