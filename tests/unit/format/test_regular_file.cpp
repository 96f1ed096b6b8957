// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/regular_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

TEST(RegularFile, IsAFileAndALinkToOne) {
  const samples::TemporaryFolder folder;
  std::ofstream(folder / "file") << "text";
  fs::create_symlink(folder / "file", folder / "link");
  EXPECT_EQ(other_kind_of_file(folder / "file"), "");
  EXPECT_EQ(other_kind_of_file(folder / "link"), "");
  EXPECT_EQ(other_kind_of_file(folder / "absent"), "");
  EXPECT_NO_THROW(require_regular_file(folder / "link", ""));
}

TEST(RegularFile, WhatIsNoneIsNamed) {
  const samples::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "fifo").c_str(), 0600), 0);
  const int end = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (folder / "socket").c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(bind(end, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(end);
  EXPECT_EQ(other_kind_of_file(folder / "fifo"), "a FIFO");
  EXPECT_EQ(other_kind_of_file(folder / "socket"), "a socket");
  EXPECT_EQ(other_kind_of_file(folder / "."), "a folder");
  EXPECT_EQ(other_kind_of_file("/dev/null"), "a device");
  try {
    require_regular_file(folder / "fifo", "name a library.h5");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_THAT(error.what(), testing::HasSubstr("a FIFO; name a library.h5"));
  }
}

}  // namespace
}  // namespace palpate
