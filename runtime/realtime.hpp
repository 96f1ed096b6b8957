// SPDX-License-Identifier: Apache-2.0
// What a thread asks of the system to be on time.
#pragma once

#include <cstdint>
#include <string>

namespace palpate::runtime {

struct RealtimeSettings {
  int priority = 80;  ///< of SCHED_FIFO, 1 to 99; 0 = the ordinary scheduler
  int core = -1;      ///< processor to stay on; -1 = any
};

/// Makes the calling thread real-time: locks the memory of the process, touches the stack, asks for
/// SCHED_FIFO and the processor. What the system refuses is left, and named in one line with what
/// to do about it; empty when all was granted. Allocates: before the loop, not in it.
std::string become_realtime(const RealtimeSettings& settings);

std::int64_t monotonic_ns() noexcept;               ///< CLOCK_MONOTONIC, ns; no system call
void sleep_until(std::int64_t monotonic) noexcept;  ///< absolute, so that periods do not drift

}  // namespace palpate::runtime
