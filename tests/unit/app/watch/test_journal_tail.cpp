// SPDX-License-Identifier: AGPL-3.0-or-later
// A session is followed while it is written, and never notices.
#include "app/watch/journal_tail.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "format/session_journal.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

class JournalTailTest : public testing::Test {
 protected:
  std::vector<RecordedStep> steps(std::size_t from, std::size_t to) const {
    const auto at = [&](std::size_t i) {
      return sample_.steps.begin() + static_cast<std::ptrdiff_t>(i);
    };
    return {at(from), at(to)};
  }
  std::vector<std::int64_t> times(const SessionNews& news) const {
    std::vector<std::int64_t> out;
    for (const RecordedStep& step : news.steps) out.push_back(step.time_ns);
    return out;
  }
  std::vector<std::int64_t> times(std::size_t from, std::size_t to) const {
    return times({{}, steps(from, to), false});
  }

  const Recording sample_ = samples::recording(4);
  const samples::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "recording.journal";
};

TEST_F(JournalTailTest, GivesEachStepOnceAsItIsAppended) {
  JournalTail tail(path_);
  EXPECT_FALSE(tail.poll().begun);  // there is no session
  SessionJournal journal(path_, sample_);
  SessionNews news = tail.poll();
  ASSERT_TRUE(news.begun);
  EXPECT_EQ(news.begun->device, sample_.device);
  EXPECT_TRUE(news.steps.empty());
  journal.append(steps(0, 5));
  journal.append(steps(5, 7));
  news = tail.poll();
  EXPECT_FALSE(news.begun);
  EXPECT_EQ(times(news), times(0, 7));
  EXPECT_TRUE(tail.poll().steps.empty());
  journal.append(steps(7, 9));
  EXPECT_EQ(times(tail.poll()), times(7, 9));
  EXPECT_EQ(tail.poll().ended, false);
}

TEST_F(JournalTailTest, TheLastStepsComeBeforeTheEndAndThenTheNextSession) {
  JournalTail tail(path_);
  {
    SessionJournal journal(path_, sample_);
    journal.append(steps(0, 2));
    EXPECT_EQ(times(tail.poll()), times(0, 2));
    journal.append(steps(2, 6));
    journal.remove();
  }
  SessionNews news = tail.poll();
  EXPECT_EQ(times(news), times(2, 6));
  EXPECT_TRUE(news.ended);
  EXPECT_FALSE(tail.poll().begun);
  SessionJournal next(path_, sample_);
  next.append(steps(0, 1));
  news = tail.poll();
  EXPECT_TRUE(news.begun);
  EXPECT_EQ(times(news), times(0, 1));
}

TEST_F(JournalTailTest, HoldsNoLock) {
  JournalTail tail(path_);
  { SessionJournal(path_, sample_).append(steps(0, 3)); }  // left by a crash
  EXPECT_TRUE(tail.poll().begun);
  RecordFile held(path_, "it is held", "");  // what the next session does
  EXPECT_EQ(tail.poll().ended, false);
}

TEST_F(JournalTailTest, WaitsForTheRestOfARecord) {
  std::string whole;
  {
    SessionJournal journal(path_, sample_);
    journal.append(steps(0, 3));
    std::ifstream file(path_, std::ios::binary);
    whole.assign(std::istreambuf_iterator<char>(file), {});
    journal.remove();
  }
  std::ofstream file(path_, std::ios::binary);
  JournalTail tail(path_);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(seen, 0U);
    file.put(whole[i]).flush();
    const SessionNews news = tail.poll();
    EXPECT_FALSE(news.ended);
    seen += news.steps.size();
  }
  EXPECT_EQ(seen, 3U);
}

}  // namespace
}  // namespace palpate::app
