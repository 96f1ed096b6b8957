// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/realtime.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <ctime>
#include <string>
#include <thread>

namespace palpate::test {
namespace {

using runtime::become_realtime;

/// In a thread of its own: the scheduler of the test program stays as it is.
std::string missing_rights(const runtime::RealtimeSettings& settings) {
  std::string missing;
  std::thread([&] { missing = become_realtime(settings); }).join();
  return missing;
}

TEST(BecomeRealtime, NamesEachRefusedRequestInOneLine) {
  const std::string missing = missing_rights({1000, 100000});  // no system grants these
  EXPECT_NE(missing.find("no SCHED_FIFO priority"), std::string::npos) << missing;
  EXPECT_NE(missing.find("rtprio"), std::string::npos) << missing;
  EXPECT_NE(missing.find("not pinned"), std::string::npos) << missing;
  EXPECT_EQ(missing.find('\n'), std::string::npos) << missing;
}

TEST(BecomeRealtime, RequestsNoPriorityAndNoProcessorThatAreNotAskedFor) {
  const std::string missing = missing_rights({0, -1});
  EXPECT_EQ(missing.find("SCHED_FIFO"), std::string::npos) << missing;
  EXPECT_EQ(missing.find("pinned"), std::string::npos) << missing;
}

TEST(BecomeRealtime, PinsTheThreadToTheProcessor) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  int core = 0;
  while (!CPU_ISSET(static_cast<std::size_t>(core), &allowed)) ++core;
  int ran_on = -1;
  std::thread([&] {
    const std::string missing = become_realtime({0, core});
    EXPECT_EQ(missing.find("pinned"), std::string::npos) << missing;
    ran_on = sched_getcpu();
  }).join();
  EXPECT_EQ(ran_on, core);
}

TEST(MonotonicClock, SleepsUntilAnAbsoluteTime) {
  const std::int64_t due = runtime::monotonic_ns() + 2'000'000;
  runtime::sleep_until(due);
  EXPECT_GE(runtime::monotonic_ns(), due);
  runtime::sleep_until(due);  // in the past: returns at once
}

/// Processor time of the calling thread, ns.
std::int64_t busy_ns() {
  timespec spent{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return spent.tv_sec * 1'000'000'000 + spent.tv_nsec;
}

TEST(MonotonicClock, WaitsAwakeForTheLastPartOfATime) {
  constexpr std::int64_t kWait = 50'000'000, kEarly = 20'000'000;
  const std::int64_t busy = busy_ns(), start = runtime::monotonic_ns();
  runtime::wait_until(start + kWait, kEarly);
  const std::int64_t end = runtime::monotonic_ns();
  EXPECT_GE(end, start + kWait);
  EXPECT_GT(busy_ns() - busy, 0);
  EXPECT_LE(busy_ns() - busy, end - (start + kWait - kEarly));  // asleep until then
  const std::int64_t before = busy_ns();
  runtime::wait_until(start, kEarly);  // in the past
  EXPECT_LT(busy_ns() - before, kEarly / 2);
}

}  // namespace
}  // namespace palpate::test
