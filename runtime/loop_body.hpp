// SPDX-License-Identifier: Apache-2.0
// What a LoopThread runs, step after step.
#pragma once

#include <cstdint>

namespace palpate::runtime {

/// One thread calls tick() and count_overrun(); heartbeat() is called from any thread.
class LoopBody {
 public:
  LoopBody() = default;
  virtual ~LoopBody() = default;
  LoopBody(const LoopBody&) = delete;
  LoopBody& operator=(const LoopBody&) = delete;

  /// One step. due: when it should have begun, on the monotonic clock, ns. False: the loop is over.
  virtual bool tick(std::int64_t due) noexcept = 0;
  /// missed: periods that pass without a step.
  virtual void count_overrun(std::int64_t missed) noexcept = 0;
  /// When the last step began, monotonic ns; 0 before the first.
  virtual std::int64_t heartbeat() const noexcept = 0;
};

}  // namespace palpate::runtime
