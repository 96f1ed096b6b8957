// SPDX-License-Identifier: Apache-2.0
// Real-time scheduling and the monotonic clock.
#pragma once

#include <cstdint>
#include <string>

namespace palpate::runtime {

struct RealtimeSettings {
  int priority = 80;  ///< of SCHED_FIFO, 1 to 99; 0 = the ordinary scheduler
  int core = -1;      ///< processor of the thread; -1 = any
};

/// Makes the calling thread real-time: locks the memory of the process, touches the stack, requests
/// SCHED_FIFO and the processor. @return one line on each request that the system refused, with its
/// remedy; empty when all were granted. Allocates: call it before the loop.
std::string become_realtime(const RealtimeSettings& settings);

std::int64_t monotonic_ns() noexcept;               ///< CLOCK_MONOTONIC, ns; no system call
void sleep_until(std::int64_t monotonic) noexcept;  ///< absolute, so that periods do not drift
/// Sleeps until `early` (ns, >= 0) before a time, and reads the clock until it has come: a system
/// wakes a thread tens of microseconds late, more on a virtual machine.
void wait_until(std::int64_t monotonic, std::int64_t early) noexcept;

}  // namespace palpate::runtime
