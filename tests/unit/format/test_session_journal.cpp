// SPDX-License-Identifier: AGPL-3.0-or-later
// What a session wrote down is there after it was cut off anywhere, and nothing else is.
#include "format/session_journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <set>
#include <sstream>

#include "format/error.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using samples::SmallDisk;
using samples::TemporaryFolder;
using testing::HasSubstr;

std::string bytes_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class SessionJournalTest : public testing::Test {
 protected:
  /// Steps [from, to) of the sample.
  std::vector<RecordedStep> steps(std::size_t from, std::size_t to) const {
    const auto at = [&](std::size_t i) {
      return session_.steps.begin() + static_cast<std::ptrdiff_t>(i);
    };
    return {at(from), at(to)};
  }

  /// The first steps of the sample in a few records; the size of the file after each.
  std::vector<std::uintmax_t> write_some() {
    SessionJournal journal(path_, session_);
    std::vector<std::uintmax_t> sizes{fs::file_size(path_)};
    for (const std::size_t i : {0U, 7U, 14U}) {
      journal.append(steps(i, i + 7));
      sizes.push_back(fs::file_size(path_));
    }
    return sizes;
  }

  /// What a recording of the first `count` steps of the sample must be.
  std::string expected(std::size_t count) const {
    Recording recording = session_;
    recording.steps.resize(count);
    return samples::dump(recording);
  }

  std::string recovered() const {
    write_recording_of(path_, folder_ / "recording.h5", session_.provenance);
    return samples::dump(read_recording(folder_ / "recording.h5"));
  }

  const TemporaryFolder folder_;
  const fs::path path_ = folder_ / "recording.journal";
  const Recording session_ = samples::recording(4);
};

TEST_F(SessionJournalTest, BecomesTheRecordingThatWouldHaveBeenWrittenAtOnce) {
  {
    SessionJournal journal(path_, session_);
    for (std::size_t i = 0; i < session_.steps.size(); i += 321)
      journal.append(steps(i, std::min(i + 321, session_.steps.size())));
    EXPECT_EQ(journal.steps(), session_.steps.size());
  }
  EXPECT_EQ(write_recording_of(path_, folder_ / "recording.h5", session_.provenance),
            session_.steps.size());
  write_recording(folder_ / "at-once.h5", session_);
  EXPECT_EQ(bytes_of(folder_ / "recording.h5"), bytes_of(folder_ / "at-once.h5"));
  EXPECT_EQ(samples::dump(read_recording(folder_ / "recording.h5")), samples::dump(session_));
}

TEST_F(SessionJournalTest, IsFollowedWhileItIsWritten) {
  SessionJournal journal(path_, session_);
  SessionJournalReader reader(path_);
  std::vector<RecordedStep> got;
  EXPECT_FALSE(reader.follow(got));
  for (const std::size_t i : {0U, 7U, 14U}) {
    journal.append(steps(i, i + 7));
    ASSERT_TRUE(reader.follow(got));
    ASSERT_EQ(got.size(), 7U);
    EXPECT_EQ(got.front().time_ns, session_.steps[i].time_ns);
    EXPECT_FALSE(reader.follow(got));
  }
}

TEST_F(SessionJournalTest, CutAnywhereItGivesEveryWholeRecord) {
  const auto sizes = write_some();
  std::set<std::uintmax_t> lengths;
  for (const std::uintmax_t at : sizes)
    for (std::uintmax_t length = at - 3; length <= std::min(at + 3, sizes.back()); ++length)
      lengths.insert(length);
  for (std::uintmax_t length = sizes[0]; length < sizes.back(); length += 131)
    lengths.insert(length);
  const std::string whole = bytes_of(path_);
  for (const std::uintmax_t length : lengths) {
    std::ofstream(path_, std::ios::binary) << whole.substr(0, length);
    if (length < sizes[0]) {
      EXPECT_THROW(summarize_session(path_), Error) << length;
      continue;
    }
    std::size_t records = 0;
    while (records + 1 < sizes.size() && sizes[records + 1] <= length) ++records;
    const SessionSummary summary = summarize_session(path_);
    ASSERT_EQ(summary.steps, 7 * records) << length;
    ASSERT_EQ(summary.incomplete_bytes, length - sizes[records]) << length;
  }
  EXPECT_EQ(recovered(), expected(21));
}

TEST_F(SessionJournalTest, WhereverAByteIsDamagedOnlyItsRecordIsLost) {
  // Steps 7 to 14: length (4 bytes), steps, digest (64).
  const auto sizes = write_some();
  const std::string whole = bytes_of(path_);
  for (const std::uintmax_t at : {sizes[1], sizes[1] + 1, sizes[1] + 3, sizes[1] + 4,
                                  sizes[1] + 100, sizes[2] - 64, sizes[2] - 1}) {
    std::string bytes = whole;
    bytes[at] ^= 1;
    std::ofstream(path_, std::ios::binary) << bytes;
    const SessionSummary summary = summarize_session(path_);
    ASSERT_EQ(summary.steps, 14U) << at;
    ASSERT_EQ(summary.incomplete_bytes, 0U) << at;
    ASSERT_EQ(summary.gaps.size(), 1U) << at;
    const JournalGap& gap = summary.gaps.front();
    EXPECT_EQ(gap.offset, sizes[1]) << at;
    EXPECT_EQ(gap.bytes, sizes[2] - sizes[1]) << at;
    EXPECT_EQ(gap.steps, 7U) << at;
    EXPECT_EQ(gap.since_ns, session_.steps[6].time_ns) << at;
    EXPECT_EQ(gap.until_ns, session_.steps[14].time_ns) << at;
  }
  Recording rest = session_;
  rest.steps = steps(0, 7);
  const auto last = steps(14, 21);
  rest.steps.insert(rest.steps.end(), last.begin(), last.end());
  EXPECT_EQ(recovered(), samples::dump(rest));
}

TEST_F(SessionJournalTest, BytesThatAreMissingOrTooManyAreAGap) {
  const auto sizes = write_some();
  const std::string whole = bytes_of(path_);
  std::ofstream(path_, std::ios::binary)
      << whole.substr(0, sizes[1] + 50) << whole.substr(sizes[1] + 60);
  EXPECT_EQ(summarize_session(path_).steps, 14U);
  EXPECT_EQ(summarize_session(path_).gaps.at(0).steps, std::nullopt);
  std::ofstream(path_, std::ios::binary)
      << whole.substr(0, sizes[1]) << std::string(3'000'000, '\0') << whole.substr(sizes[1]);
  EXPECT_EQ(summarize_session(path_).steps, 21U);
  EXPECT_EQ(summarize_session(path_).gaps.at(0).bytes, 3'000'000U);
}

TEST_F(SessionJournalTest, DamageInTheLastRecordIsNotTakenForACrash) {
  const auto sizes = write_some();
  std::string bytes = bytes_of(path_);
  bytes[sizes[2] + 100] ^= 1;
  std::ofstream(path_, std::ios::binary) << bytes;
  const SessionSummary summary = summarize_session(path_);
  EXPECT_EQ(summary.steps, 14U);
  ASSERT_EQ(summary.gaps.size(), 1U);
  EXPECT_EQ(summary.gaps.front().steps, 7U);
  EXPECT_EQ(summary.gaps.front().until_ns, std::nullopt);
}

TEST_F(SessionJournalTest, StepsBehindADamagedHeadingAreNotOverwritten) {
  write_some();
  std::string bytes = bytes_of(path_);
  bytes[30] ^= 1;
  std::ofstream(path_, std::ios::binary) << bytes;
  EXPECT_TRUE(holds_session(path_));
  try {
    summarize_session(path_);
    ADD_FAILURE() << "read without its heading";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("heading is damaged"));
  }
  EXPECT_THROW(SessionJournal(path_, session_), Error);
  EXPECT_EQ(bytes_of(path_), bytes);
}

TEST_F(SessionJournalTest, AnAbsurdLengthIsDamageAndTakesNoMemory) {
  const auto sizes = write_some();
  std::string bytes = bytes_of(path_);
  for (std::size_t i = 0; i < 4; ++i) bytes[sizes[0] + i] = '\xff';
  std::ofstream(path_, std::ios::binary) << bytes;
  EXPECT_EQ(summarize_session(path_).steps, 14U);
}

TEST_F(SessionJournalTest, AKilledProcessLosesNothingThatWasAppended) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    SessionJournal journal(path_, session_);
    journal.append(steps(0, 1000));
    journal.append(steps(1000, 1500));
    raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(recovered(), expected(1500));
}

TEST_F(SessionJournalTest, WhenTheDiskIsFullItIsAsBefore) {
  SessionJournal journal(path_, session_);
  journal.append(steps(0, 10));
  const std::uintmax_t size = fs::file_size(path_);
  {
    const SmallDisk disk(size + 500);  // in the middle of the next record
    EXPECT_THROW(journal.append(steps(10, 20)), Error);
  }
  EXPECT_EQ(fs::file_size(path_), size);
  journal.append(steps(10, 12));
  EXPECT_EQ(recovered(), expected(12));
}

TEST_F(SessionJournalTest, AFullDiskIsMetBeforeTheRecordingIsBegunAndTheJournalStays) {
  write_some();
  const SmallDisk disk(100'000);
  try {
    write_recording_of(path_, folder_ / "recording.h5", session_.provenance);
    ADD_FAILURE() << "written on a disk without room";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("recording.h5"));
  }
  EXPECT_THAT(folder_.names(), testing::UnorderedElementsAre("recording.journal"));
  EXPECT_EQ(summarize_session(path_).steps, 21U);
}

TEST_F(SessionJournalTest, BelongsToOneSession) {
  {
    const SessionJournal first(path_, session_);
    try {
      const SessionJournal second(path_, session_);
      ADD_FAILURE() << "two sessions at a time";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      EXPECT_THAT(error.what(), HasSubstr("another palpate"));
    }
  }
  try {
    const SessionJournal second(path_, session_);
    ADD_FAILURE() << "the session before was overwritten";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("palpate recover"));
  }
}

TEST_F(SessionJournalTest, BeginsAnewWhereAHeadingWasCutShort) {
  write_some();
  for (const std::size_t length : {0U, 5U, 18U, 20U, 60U}) {
    fs::resize_file(path_, length);
    EXPECT_NO_THROW(SessionJournal(path_, session_).append(steps(0, 3)));
    EXPECT_EQ(summarize_session(path_).steps, 3U);
  }
}

TEST_F(SessionJournalTest, RefusesAFileThatIsNoJournal) {
  std::ofstream(path_) << "a letter to a friend\n";
  EXPECT_FALSE(is_session_journal(path_));
  EXPECT_THROW(SessionJournalReader{path_}, Error);
  EXPECT_THROW(SessionJournal(path_, session_), Error);
  EXPECT_EQ(bytes_of(path_), "a letter to a friend\n");
}

}  // namespace
}  // namespace palpate
