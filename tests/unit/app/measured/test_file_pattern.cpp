// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/file_pattern.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class FilePatterns : public testing::Test {
 protected:
  FilePatterns() {
    for (const char* name :
         {"run-2-a.csv", "run-10-b.csv", "run-1-a.csv", "run-1-a.txt", "a+b.csv", ".run-3-a.csv"})
      std::ofstream(folder_ / name) << "x\n";
    std::filesystem::create_directories(folder_ / "tool 5" / "run-7-a.csv");  // a folder is no file
    std::ofstream(folder_ / "tool 5" / "run-3.csv") << "x\n";
  }
  std::vector<std::string> names(const std::string& pattern) const {
    std::vector<std::string> found;
    for (const MatchedFile& match : matching_files(folder_.path(), pattern, "here"))
      found.push_back(match.file.string());
    return found;
  }
  template <class Work>
  static std::string pattern_refusal(Work work) {
    try {
      work();
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
  std::string refusal(const std::string& pattern) const {
    return pattern_refusal([&] { names(pattern); });
  }
  std::string list_refusal(const std::string& text) const {
    std::ofstream(folder_ / "list.csv") << text;
    return pattern_refusal([&] { read_list(folder_ / "list.csv"); });
  }
  const samples::TemporaryFolder folder_;
};

TEST_F(FilePatterns, FindFilesInTheOrderOfTheirNumbers) {
  EXPECT_THAT(names("run-*.csv"), ElementsAre("run-1-a.csv", "run-2-a.csv", "run-10-b.csv"));
  EXPECT_THAT(names("run-?-a.*"), ElementsAre("run-1-a.csv", "run-1-a.txt", "run-2-a.csv"));
  EXPECT_THAT(names("a+b.csv"), ElementsAre("a+b.csv"));
  EXPECT_THAT(names("tool*/run-*.csv"), ElementsAre("tool 5/run-3.csv"));
  EXPECT_THAT(names("./a+?.csv"), ElementsAre("./a+b.csv"));
  EXPECT_THAT(refusal("run-9*.csv"), HasSubstr("no file matches 'run-9*.csv'"));
  EXPECT_THAT(refusal("none/*.csv"), HasSubstr("no file matches"));
  EXPECT_THAT(refusal("a.b.csv"), HasSubstr("no file matches"));
}

TEST_F(FilePatterns, TakeWhatVariesFromTheNames) {
  const auto runs = matching_files(folder_.path(), "run-{n}-{side}.csv", "here");
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_THAT(runs[2].values, ElementsAre(Pair("n", "10"), Pair("side", "b")));
  const auto tools = matching_files(folder_.path(), "tool {r}/run-{n}.csv", "here");
  EXPECT_THAT(tools.at(0).values, ElementsAre(Pair("n", "3"), Pair("r", "5")));
  EXPECT_EQ(filled_in("{n} mm of {side}", runs[2].values, ""), "10 mm of b");
  EXPECT_EQ(filled_in("plain", {}, ""), "plain");
  EXPECT_THAT(pattern_refusal([&] { filled_in("{m} mm", runs[0].values, "here"); }),
              HasSubstr("uses {m}, which nothing gives; known are {n}, {side}"));
  EXPECT_THAT(refusal("run-{n-*.csv"), HasSubstr("brace"));
  EXPECT_THAT(refusal("run-{}-*.csv"), HasSubstr("brace"));
  EXPECT_THAT(refusal("run-{n}-{n}.csv"), HasSubstr("{n} stands twice"));
  EXPECT_THAT(refusal(""), HasSubstr("the pattern is empty"));
}

TEST_F(FilePatterns, ListsHaveARowForEachRecord) {
  std::ofstream(folder_ / "list.csv") << "file; x; note\na.csv; 1.5; \"soft; wet\"\nb.csv; 2; -\n";
  const auto rows = read_list(folder_ / "list.csv");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].at("note"), "soft; wet");
  EXPECT_EQ(rows[1].at("x"), "2");
  EXPECT_THAT(list_refusal("file,x\n"), HasSubstr("no rows"));
  EXPECT_THAT(list_refusal("file,x\na\n"), HasSubstr("list.csv:2: the row has 1 fields"));
  EXPECT_THAT(list_refusal("x,x\na,b\n"), HasSubstr("'x' stands twice"));
  EXPECT_THAT(pattern_refusal([&] { read_list(folder_ / "absent.csv"); }),
              HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace palpate::app
