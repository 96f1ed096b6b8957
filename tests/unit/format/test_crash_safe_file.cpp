// SPDX-License-Identifier: AGPL-3.0-or-later
// Nothing half-written ever has the final name.
#include "format/crash_safe_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate {
namespace {

using samples::expect_refusal;
using samples::TemporaryFolder;
using samples::text_of;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;
using testing::UnorderedElementsAre;
using Path = std::filesystem::path;

TEST(CrashSafeFile, BearsTheFinalNameOnlyOnceCommitted) {
  const TemporaryFolder folder;
  {
    CrashSafeFile file(folder / "report.html");
    file.write("half");
    EXPECT_THAT(folder.names(),
                ElementsAre(StartsWith(".report.html.partial-" + std::to_string(getpid()) + "-")));
    file.write(" and half");
    file.commit();
  }
  EXPECT_THAT(folder.names(), UnorderedElementsAre("report.html"));
  EXPECT_EQ(text_of(folder / "report.html"), "half and half");
}

TEST(CrashSafeFile, AbandonedLeavesNothing) {
  const TemporaryFolder folder;
  { CrashSafeFile(folder / "report.html").write("half"); }
  EXPECT_THAT(folder.names(), IsEmpty());
}

// A process killed in the middle leaves its temporary at most, never a half file under the name.
TEST(CrashSafeFile, KilledProcessLeavesThePreviousFile) {
  const TemporaryFolder folder;
  write_file_crash_safely(folder / "curves.csv", "previous content");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    CrashSafeFile file(folder / "curves.csv");
    file.write("half");
    raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(text_of(folder / "curves.csv"), "previous content");
}

/// A process that is killed while it writes, or stopped, which may go on.
pid_t writing_process(const Path& target, int signal) {
  const pid_t child = fork();
  if (child == 0) {
    CrashSafeFile file(target);
    file.write("half");
    raise(signal);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, signal == SIGSTOP ? WUNTRACED : 0);
  return child;
}

TEST(CrashSafeFile, RemovesWhatAKilledProcessLeftAndNothingElse) {
  const TemporaryFolder folder;
  const pid_t killed = writing_process(folder / "curves.h5", SIGKILL);
  ASSERT_EQ(folder.names().size(), 1U);
  const std::string left = folder.names().front();
  EXPECT_THAT(left, StartsWith(".curves.h5.partial-" + std::to_string(killed) + "-"));
  // Of another target, of another host, and names that only look like it.
  writing_process(folder / "body.h5", SIGKILL);
  const std::string host = left.substr(left.size() - 8), other = host == "00000000" ? "1" : "0";
  for (const std::string& name :
       {".curves.h5.partial-" + std::to_string(killed) + "-" + std::string(8, other[0]),
        ".curves.h5.partial-x-" + host, ".curves.h5.partial--" + host, std::string("notes.txt")})
    std::ofstream(folder / name) << "kept";
  const pid_t stopped = writing_process(folder / "curves.h5", SIGSTOP);
  const auto before = folder.names();
  EXPECT_EQ(before.size(), 6U) << "the stopped process has removed what the killed one left";
  write_file_crash_safely(folder / "curves.h5", "whole");
  auto after = folder.names();
  std::erase(after, "curves.h5");
  EXPECT_THAT(after, testing::UnorderedElementsAreArray(before));
  kill(stopped, SIGKILL);
  waitpid(stopped, nullptr, 0);
  write_file_crash_safely(folder / "curves.h5", "whole again");
  EXPECT_EQ(folder.names().size(), 6U) << "that of the stopped one is gone, the file is there";
}

TEST(CrashSafeFile, FollowsASymbolicLink) {
  const TemporaryFolder folder;
  write_file_crash_safely(folder / "target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  write_file_crash_safely(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(text_of(folder / "target"), "new");
}

TEST(CrashSafeFile, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  const auto refuse = [](const Path& path, const std::string& problem) {
    expect_refusal([&] { write_file_crash_safely(path, "x"); }, ErrorKind::Configuration,
                   path.string(), problem);
  };
  refuse(folder.path(), "is not a regular file");
  refuse("/dev/null", "is not a regular file");
  refuse(folder / "absent/file", "No such file or directory");
  refuse(folder / std::string(300, 'n'), "File name too long");
  refuse(Path(folder.path()) / "", "is not a file name");
  EXPECT_THAT(folder.names(), IsEmpty());
}

}  // namespace
}  // namespace palpate
