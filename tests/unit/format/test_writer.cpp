// SPDX-License-Identifier: AGPL-3.0-or-later
// Nothing half-written, and nothing invalid, ever bears the final name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <thread>

#include "format/crash_safe_file.hpp"
#include "format/error.hpp"
#include "format/hdf5_file.hpp"
#include "format/sha256.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

using samples::SmallDisk;
using samples::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using Path = std::filesystem::path;

std::string text_of(const Path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void expect_refusal(const std::function<void()>& action, ErrorKind kind, const std::string& where,
                    const std::string& problem) {
  try {
    action();
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_THAT(error.where(), HasSubstr(where));
    EXPECT_THAT(error.problem(), HasSubstr(problem));
    EXPECT_FALSE(error.remedy().empty());
  }
}

struct Artifact {
  std::string name;
  std::function<void(const Path&)> write;
};

class FullDisk : public testing::TestWithParam<Artifact> {};

TEST_P(FullDisk, LeavesNothing) {
  const TemporaryFolder folder;
  const SmallDisk disk(4000);
  expect_refusal([&] { GetParam().write(folder / "new.h5"); }, ErrorKind::Internal, "new.h5",
                 "File too large");
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST_P(FullDisk, KeepsThePreviousFile) {
  const TemporaryFolder folder;
  std::ofstream(folder / "old.h5") << "previous content";
  const SmallDisk disk(4000);
  expect_refusal([&] { GetParam().write(folder / "old.h5"); }, ErrorKind::Internal, "old.h5",
                 "File too large");
  EXPECT_EQ(text_of(folder / "old.h5"), "previous content");
  EXPECT_THAT(folder.names(), UnorderedElementsAre("old.h5"));
}

INSTANTIATE_TEST_SUITE_P(
    Writers, FullDisk,
    testing::Values(
        Artifact{"Body", [](const Path& p) { write_body(p, samples::body(1)); }},
        Artifact{"Curves", [](const Path& p) { write_curves(p, samples::curves(1)); }},
        Artifact{"Library", [](const Path& p) { write_library(p, samples::library(1)); }},
        Artifact{"Recording", [](const Path& p) { write_recording(p, samples::recording(1)); }},
        Artifact{"Text",
                 [](const Path& p) { write_file_crash_safely(p, std::string(5000, 'x')); }}),
    [](const auto& param) { return param.param.name; });

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

TEST(Writer, RefusesInvalidContentBeforeTouchingTheDisk) {
  const TemporaryFolder folder;
  Library library = samples::library(1);
  library.responses[4].normal.slope[1] = -1;
  expect_refusal([&] { write_library(folder / "library.h5", library); }, ErrorKind::Internal,
                 "/response/normal_slope[", "is not finite and not negative");
  Curves curves = samples::curves(1);
  curves.sites[2].paths[0].samples[0].force[1] = std::numeric_limits<double>::quiet_NaN();
  expect_refusal([&] { write_curves(folder / "curves.h5", curves); }, ErrorKind::Internal,
                 "/sample/force[", "nan is not finite");
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Writer, RefusesTextsThatWouldBeCut) {
  const TemporaryFolder folder;
  Body body = samples::body(1);
  body.name = std::string("cut\0here", 8);
  expect_refusal([&] { write_body(folder / "body.h5", body); }, ErrorKind::Internal, "@name",
                 "zero byte");
  EXPECT_THAT(folder.names(), IsEmpty());
}

// Sites finish on several threads; files may be read and written meanwhile.
TEST(Writer, ThreadsMayReadAndWriteDifferentFiles) {
  const TemporaryFolder folder;
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 4; ++t) {
    threads.emplace_back([&folder, t] {
      const Path path = folder / ("library" + std::to_string(t) + ".h5");
      for (int i = 0; i < 5; ++i) {
        write_library(path, samples::library(t));
        EXPECT_EQ(samples::dump(read_library(path)), samples::dump(samples::library(t)));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace palpate
