// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/zip_archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/fitting/measurement/records/workbook_writer.hpp"

namespace palpate::measured {
namespace {

using testing::HasSubstr;

class ZipArchives : public testing::Test {
 protected:
  std::string refusal() const {
    try {
      ZipArchive(file_).member("b/c.xml");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      return error.what();
    }
    return "accepted";
  }
  const samples::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "a.zip";
};

TEST_F(ZipArchives, GiveTheirMembers) {
  std::string long_text;
  for (int i = 0; i < 500000; ++i) long_text += std::to_string(i);
  write_archive(file_, {{"a.xml", "one"}, {"b/c.xml", long_text}, {"empty", ""}});
  const ZipArchive archive(file_);
  EXPECT_EQ(archive.member("a.xml"), "one");
  EXPECT_EQ(archive.member("b/c.xml"), long_text);
  EXPECT_EQ(archive.member("empty"), "");
  EXPECT_EQ(archive.member("absent"), std::nullopt);
  EXPECT_EQ(archive.member("A.xml"), std::nullopt);
}

TEST_F(ZipArchives, ThatAreDamagedAreRefused) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += std::to_string(i * i);
  write_archive(file_, {{"b/c.xml", text}});
  const auto size = std::filesystem::file_size(file_);
  {
    std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(size / 2));
    stream.write("\x55\xAA\x55\xAA", 4);
  }
  EXPECT_THAT(refusal(), HasSubstr("it is damaged"));
  std::filesystem::resize_file(file_, size / 2);
  EXPECT_THAT(refusal(), HasSubstr("it was cut off"));
  std::filesystem::resize_file(file_, 0);
  EXPECT_THAT(refusal(), HasSubstr("it was cut off"));
}

}  // namespace
}  // namespace palpate::measured
