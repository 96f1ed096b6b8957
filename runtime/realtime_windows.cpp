// SPDX-License-Identifier: Apache-2.0
// Scheduling and clock of Windows, in place of realtime.cpp.
#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <windows.h>

#include <string>

#include "runtime/realtime.hpp"

namespace palpate::runtime {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // ns
constexpr std::int64_t kTick = 100;              // ns, unit of a timer
constexpr std::int64_t kSpin = 500'000;          // ns before the end that are not slept

#ifndef CREATE_WAITABLE_TIMER_HIGH_RESOLUTION
constexpr DWORD CREATE_WAITABLE_TIMER_HIGH_RESOLUTION = 2;  // NOLINT: the name of the system
#endif

std::int64_t ticks_per_second() noexcept {
  LARGE_INTEGER frequency;
  QueryPerformanceFrequency(&frequency);
  return frequency.QuadPart;
}

/// The timer of a thread; null where the system has none of this resolution.
class Timer {
 public:
  Timer() noexcept
      : handle_(CreateWaitableTimerExW(nullptr, nullptr, CREATE_WAITABLE_TIMER_HIGH_RESOLUTION,
                                       TIMER_ALL_ACCESS)) {}
  ~Timer() {
    if (handle_ != nullptr) CloseHandle(handle_);
  }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  /// Sleeps until kSpin before `left` ns are over, or not at all.
  void sleep(std::int64_t left) noexcept {
    if (handle_ == nullptr || left <= kSpin) return;
    LARGE_INTEGER due;
    due.QuadPart = -((left - kSpin) / kTick);  // negative: from now on
    if (SetWaitableTimer(handle_, &due, 0, nullptr, nullptr, FALSE) != 0)
      WaitForSingleObject(handle_, INFINITE);
  }

 private:
  HANDLE handle_;
};

}  // namespace

std::string become_realtime(const RealtimeSettings& settings) {
  std::string missing;
  const auto require = [&missing](bool granted, const char* what) {
    if (!granted) missing += (missing.empty() ? "" : "; ") + std::string(what);
  };
  if (settings.priority > 0)
    require(SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_TIME_CRITICAL) != 0,
            "no time-critical priority: start the program with higher rights");
  if (settings.core >= 0 && settings.core < 64)
    require(SetThreadAffinityMask(GetCurrentThread(), DWORD_PTR{1} << settings.core) != 0,
            "not pinned to a processor");
  return missing;
}

std::int64_t monotonic_ns() noexcept {
  static const std::int64_t frequency = ticks_per_second();
  LARGE_INTEGER now;
  QueryPerformanceCounter(&now);
  const std::int64_t whole = now.QuadPart / frequency, rest = now.QuadPart % frequency;
  return whole * kSecond + rest * kSecond / frequency;
}

void sleep_until(std::int64_t monotonic) noexcept {
  thread_local Timer timer;
  timer.sleep(monotonic - monotonic_ns());
  while (monotonic_ns() < monotonic) YieldProcessor();
}

void wait_until(std::int64_t monotonic, std::int64_t early) noexcept {
  sleep_until(monotonic - early);
  while (monotonic_ns() < monotonic) YieldProcessor();
}

}  // namespace palpate::runtime
