// SPDX-License-Identifier: AGPL-3.0-or-later
// Nothing half-written ever has the final name.
#include "format/crash_safe_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate {
namespace {

using samples::expect_refusal;
using samples::TemporaryFolder;
using samples::text_of;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using Path = std::filesystem::path;

TEST(CrashSafeFile, BearsTheFinalNameOnlyOnceCommitted) {
  const TemporaryFolder folder;
  {
    CrashSafeFile file(folder / "report.html");
    file.write("half");
    EXPECT_THAT(folder.names(),
                UnorderedElementsAre(".report.html.partial-" + std::to_string(getpid())));
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
