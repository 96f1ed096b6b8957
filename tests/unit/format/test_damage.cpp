// SPDX-License-Identifier: AGPL-3.0-or-later
// Files that are cut, damaged or locked, and what a refusal leaves behind.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "format/error.hpp"
#include "format/hdf5_file.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/format/breakage.hpp"

namespace palpate::samples {
namespace {

// An inverted tetrahedron is a matter of the shape, not of the file.
TEST(RejectionKind, InvertedTetrahedronIsBadGeometry) {
  const TemporaryFolder folder;
  write_body(folder / "body.h5", body(1));
  swap_corners(folder / "body.h5");
  try {
    read_body(folder / "body.h5");
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
  }
}

// A file cut at any length is refused, never read as far as it goes.
TEST(Truncation, AtAnyLength) {
  const TemporaryFolder folder;
  const Path path = folder / "library.h5";
  copy_sample(Kind::Library, path);
  const auto whole = std::filesystem::file_size(path);
  for (int part = 0; part < 50; ++part) {
    copy_sample(Kind::Library, path);
    std::filesystem::resize_file(path, whole * static_cast<std::uintmax_t>(part) / 50);
    EXPECT_THROW(static_cast<void>(read_library(path)), Error) << part << "/50";
  }
}

// One wrong byte anywhere: refused, or of no consequence (a letter of the seal's own mark). HDF5 on
// its own would read other numbers, loop, or crash.
TEST(Damage, OneByteNeverChangesWhatIsRead) {
  const TemporaryFolder folder;
  const Path path = folder / "library.h5";
  const std::string known = dump(library(1));
  copy_sample(Kind::Library, path);
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(path));
  int refused = 0, harmless = 0;
  constexpr std::streamoff kSeal = 81;
  for (std::streamoff position = 0; position < size;
       position += position < size - kSeal - 211 ? 211 : 1) {
    copy_sample(Kind::Library, path);
    {
      std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
      const int good = file.seekg(position).get();
      file.seekp(position).put(static_cast<char>(good ^ 0x55));
    }
    try {
      EXPECT_EQ(dump(read_library(path)), known) << "byte " << position;
      ++harmless;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("is damaged")) << "byte " << position;
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
  EXPECT_EQ(harmless, 17) << "letters of the mark and the last line end";
}

// HDF5 cannot lock a file on some network disks, nor one that another program holds.
TEST(Locking, RefusedLockNamesTheSwitch) {
  const TemporaryFolder folder;
  const Path path = folder / "body.h5";
  copy_sample(Kind::Body, path);
  const int descriptor = open(path.c_str(), O_RDWR);
  ASSERT_EQ(flock(descriptor, LOCK_EX), 0);
  try {
    static_cast<void>(read_body(path));
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.remedy(), testing::HasSubstr("HDF5_USE_FILE_LOCKING=FALSE"));
  }
  close(descriptor);
}

// HDF5's printing belongs to the program around; it must be as before.
TEST(Silence, ErrorPrintingIsRestored) {
  H5E_auto2_t before = nullptr, after = nullptr;
  void *before_data = nullptr, *after_data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &before_data);
  testing::internal::CaptureStderr();
  const TemporaryFolder folder;
  write_body(folder / "body.h5", body(1));
  truncate_half(folder / "body.h5");
  EXPECT_THROW(static_cast<void>(read_body(folder / "body.h5")), Error);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  H5Eget_auto2(H5E_DEFAULT, &after, &after_data);
  EXPECT_EQ(before, after);
  EXPECT_EQ(before_data, after_data);
}

// Every identifier is closed again, also on the way out of a failure.
TEST(Identifiers, NoneIsLeftOpen) {
  const TemporaryFolder folder;
  write_library(folder / "library.h5", library(1));
  static_cast<void>(read_library(folder / "library.h5"));
  poke("/response/normal_slope", 1, -1.0)(folder / "library.h5");
  EXPECT_THROW(static_cast<void>(read_library(folder / "library.h5")), Error);
  EXPECT_EQ(H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL), 0);
}

}  // namespace
}  // namespace palpate::samples
