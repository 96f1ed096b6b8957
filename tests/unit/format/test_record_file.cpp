// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/record_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

TEST(Record, IsTakenOnlyWhenItIsWholeAndMatchesItsDigest) {
  const std::string two = record_of("first") + record_of("second");
  std::string_view rest = two, payload;
  ASSERT_TRUE(take_record(rest, payload));
  EXPECT_EQ(payload, "first");
  ASSERT_TRUE(take_record(rest, payload));
  EXPECT_EQ(payload, "second");
  EXPECT_FALSE(take_record(rest, payload));
  const std::string one = record_of("first");
  for (std::size_t length = 0; length < one.size(); ++length) {
    std::string_view cut = std::string_view(one).substr(0, length);
    EXPECT_FALSE(take_record(cut, payload)) << length;
  }
  for (std::size_t at = 0; at < one.size(); ++at) {
    std::string damaged = one;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
    std::string_view bytes = damaged;
    EXPECT_FALSE(take_record(bytes, payload)) << at;
  }
}

TEST(RecordFile, AppendsAndCuts) {
  const samples::TemporaryFolder folder;
  RecordFile file(folder / "a.journal", "is busy", "wait");
  file.append("one");
  file.append_durably("two");
  file.synchronize();
  EXPECT_EQ(text_of(file.path()), "onetwo");
  file.cut(3);
  file.append("three");
  EXPECT_EQ(text_of(file.path()), "onethree");
  file.remove();
  EXPECT_FALSE(std::filesystem::exists(folder / "a.journal"));
}

TEST(RecordFile, RefusesAFileThatIsOpenElsewhere) {
  const samples::TemporaryFolder folder;
  const RecordFile file(folder / "a.journal", "is busy", "wait");
  try {
    const RecordFile again(folder / "a.journal", "is busy", "wait");
    FAIL() << "was opened twice";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_EQ(error.problem(), "is busy");
    EXPECT_EQ(error.remedy(), "wait");
  }
}

}  // namespace
}  // namespace palpate
