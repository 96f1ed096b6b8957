// SPDX-License-Identifier: Apache-2.0
#include "runtime/realtime.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <ctime>

namespace palpate::runtime {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // ns

/// Touches the pages of the stack that the loop may use, so that it has no page faults.
void touch_stack() noexcept {
  constexpr std::size_t kDepth = std::size_t{256} * 1024;
  constexpr std::size_t kPage = 4096;
  char stack[kDepth];
  volatile char* at = stack;
  for (std::size_t i = 0; i < kDepth; i += kPage) at[i] = 0;
}

void add(std::string& line, const std::string& text) {
  line += (line.empty() ? "" : "; ") + text;
}

std::string reason(int error) {
  return std::string(" (") + std::strerror(error) + ")";
}

}  // namespace

std::string become_realtime(const RealtimeSettings& settings) {
  std::string missing;
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    add(missing, "memory not locked" + reason(errno) + ": raise `ulimit -l`");
  }
  touch_stack();
  if (settings.priority > 0) {
    sched_param parameter{};
    parameter.sched_priority = settings.priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
    if (error != 0) {
      add(missing,
          "no SCHED_FIFO priority" + reason(error) + ": raise rtprio in /etc/security/limits.conf");
    }
  }
  if (settings.core >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(settings.core), &set);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
    if (error != 0) add(missing, "not pinned to a processor" + reason(error));
  }
  return missing;
}

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

void sleep_until(std::int64_t monotonic) noexcept {
  timespec at{};
  at.tv_sec = monotonic / kSecond;
  at.tv_nsec = monotonic % kSecond;
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) == EINTR) {
  }
}

void wait_until(std::int64_t monotonic, std::int64_t early) noexcept {
  sleep_until(monotonic - early);
  while (monotonic_ns() < monotonic) {
  }
}

}  // namespace palpate::runtime
