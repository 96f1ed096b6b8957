// SPDX-License-Identifier: Apache-2.0
// The status bits of a step.
#pragma once

#include <cstdint>

namespace palpate::runtime::step_status {

/// Equal to the PALPATE_* bits of palpate.h, where each is explained. From 1 << 16 on: set by the
/// force loop.
enum Bit : std::uint32_t {
  Contact = 1U << 0,
  Activated = 1U << 1,
  Released = 1U << 2,
  Sliding = 1U << 3,
  AtBorder = 1U << 4,
  EnergyLimited = 1U << 5,
  BeyondDepth = 1U << 6,
  BadInput = 1U << 7,
  Dropped = 1U << 8,
  ForceLimited = 1U << 9,
  Awaiting = 1U << 10,
  SkinLags = 1U << 11,
  LoopRamping = 1U << 16,
  LoopClamped = 1U << 17,
  LoopTooFast = 1U << 18,
  LoopLate = 1U << 19,
  LoopNotFinite = 1U << 20,
  LoopSaturated = 1U << 21,
  LoopStale = 1U << 22,
  LoopDeviceLost = 1U << 23,
  LoopOutdated = 1U << 24,
  LoopRejected = 1U << 25
};

}  // namespace palpate::runtime::step_status
