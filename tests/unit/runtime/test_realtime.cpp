// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/realtime.hpp"

#include <gtest/gtest.h>
#include <sched.h>

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

}  // namespace
}  // namespace palpate::test
