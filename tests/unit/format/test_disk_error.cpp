// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/disk_error.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate {
namespace {

/// Whose fault it is decides the exit code: a path is configuration, a disk is not.
TEST(DiskError, TellsTheUserFromTheDisk) {
  struct Case {
    int number;
    ErrorKind kind;
    const char* remedy;
  };
  for (const auto& [number, kind, remedy] :
       {Case{ENOSPC, ErrorKind::Internal, "free some space"},
        Case{EDQUOT, ErrorKind::Internal, "free some space"},
        Case{EFBIG, ErrorKind::Internal, "ulimit"},
        Case{EIO, ErrorKind::Internal, "check the disk"},
        Case{EACCES, ErrorKind::Configuration, "may write to"},
        Case{EROFS, ErrorKind::Configuration, "may write to"},
        Case{ENOENT, ErrorKind::Configuration, "correct the path"},
        Case{ENOTDIR, ErrorKind::Configuration, "correct the path"},
        Case{ENAMETOOLONG, ErrorKind::Configuration, "shorter"},
        Case{EBUSY, ErrorKind::Internal, "remove the cause"}}) {
    try {
      throw_disk_error("/a/b.h5", "cannot be written", number);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << number;
      EXPECT_EQ(error.where(), "/a/b.h5");
      EXPECT_NE(error.remedy().find(remedy), std::string::npos) << error.remedy();
      const std::string reason = std::generic_category().message(number);
      EXPECT_EQ(error.problem(), "cannot be written (" + reason + ")");
    }
  }
}

TEST(DiskError, SyncsTheFolderOfAFileWhetherOrNotThatExists) {
  const samples::TemporaryFolder folder;
  EXPECT_EQ(sync_folder_of(folder / "later.h5"), 0);
  EXPECT_EQ(sync_folder_of("bare-name.h5"), 0);
  EXPECT_EQ(sync_folder_of(folder / "none" / "later.h5"), ENOENT);
  std::ofstream(folder / "file") << "x";
  EXPECT_EQ(sync_folder_of(folder / "file" / "later.h5"), ENOTDIR);
}

}  // namespace
}  // namespace palpate
