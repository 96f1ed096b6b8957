// SPDX-License-Identifier: AGPL-3.0-or-later
// What a campaign says when a signal ends it. Each case is a process of its own.
#include "app/interruption.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace palpate::app {
namespace {

/// Follows a campaign of 238 sites up to `done` sites, then receives the signal.
void interrupt_after(std::int64_t done, int signal) {
  const EventSink sink = with_interruption_note([](const Event&) {});
  CampaignStarted started;
  started.journal = "out/liver/curves.journal";
  sink(started);
  for (std::int64_t i = 0; i <= done; ++i) sink(Progress{i, 0, 2, 238, 0, {}});
  std::raise(signal);
}

TEST(InterruptionDeathTest, SaysHowManySitesAreKept) {
  EXPECT_EXIT(interrupt_after(69, SIGINT), ::testing::KilledBySignal(SIGINT),
              "interrupted; 69 of 238 sites are kept in out/liver/curves.journal: run the same "
              "command to go on");
  EXPECT_EXIT(interrupt_after(70, SIGTERM), ::testing::KilledBySignal(SIGTERM), "70 of 238");
}

TEST(InterruptionDeathTest, SaysThatNothingIsKept) {
  EXPECT_EXIT(interrupt_after(0, SIGINT), ::testing::KilledBySignal(SIGINT),
              "before the first site was finished");
}

TEST(InterruptionDeathTest, IsSilentAfterTheCampaign) {
  const auto end = [] {
    const EventSink sink = with_interruption_note([](const Event&) {});
    sink(CampaignStarted{});
    sink(Progress{5, 0, 0, 5, 0, {}});
    sink(CampaignFinished{});
    std::raise(SIGINT);
  };
  EXPECT_EXIT(end(), ::testing::KilledBySignal(SIGINT), "^$");
}

TEST(Interruption, HandsEveryEventOn) {
  int events = 0;
  const EventSink sink = with_interruption_note([&](const Event&) { ++events; });
  sink(LogLine{"fit", "text"});
  sink(Warning{"fit", "text"});
  EXPECT_EQ(events, 2);
}

}  // namespace
}  // namespace palpate::app
