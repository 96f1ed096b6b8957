// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/command_line/man_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <string>

namespace palpate::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ManPage : public ::testing::Test {
 protected:
  ManPage() {
    root_.footer("Exit codes: 0 success.\n.A line with a dot");
    sub_->add_option("CASE", file_, "Case file (TOML)")->required();
    sub_->add_option("--out", file_, "Folder of the artifacts");
    sub_->add_option("--memory", file_, "Memory, e.g. 8GB")->option_text("SIZE");
    sub_->add_option("--count", count_, "How many")->check(CLI::Range(1, 9));
    sub_->add_flag("-j,--json")->description("Events as JSON");
  }

  CLI::App root_{"renders soft bodies", "palpate"};
  CLI::App* sub_ = root_.add_subcommand("export", "Exports artifacts");
  CLI::App* deep_ = sub_->add_subcommand("site", "A site");

 private:
  std::string file_;
  int count_ = 0;
};

TEST_F(ManPage, IsNamedByTheWordsOfTheCommand) {
  EXPECT_EQ(man_page_name(root_), "palpate");
  EXPECT_EQ(man_page_name(*deep_), "palpate-export-site");
}

TEST_F(ManPage, HasTheSectionsOfAPage) {
  const std::string page = man_page(*sub_, "palpate 1.2");
  EXPECT_THAT(page, HasSubstr(".TH PALPATE\\-EXPORT 1 \"\" \"palpate 1.2\"\n"));
  EXPECT_THAT(page, HasSubstr(".SH NAME\npalpate\\-export \\- Exports artifacts\n"));
  EXPECT_THAT(page, HasSubstr(".SH SYNOPSIS\n\\fBpalpate export\\fR [\\fIoption\\fR]... "
                              "\\fIsubcommand\\fR \\fICASE\\fR\n"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fBpalpate\\-export\\-site\\fR(1)\nA site\n"));
  EXPECT_THAT(page, HasSubstr(".SH SEE ALSO\n\\fBpalpate\\fR(1)\n"));
}

TEST_F(ManPage, DescribesEveryOptionWithItsValue) {
  const std::string page = man_page(*sub_, "");
  EXPECT_THAT(page, HasSubstr(".TP\n\\fICASE\\fR\nCase file (TOML)\n"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fB\\-\\-out\\fR \\fITEXT\\fR\nFolder of the artifacts\n"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fB\\-\\-memory\\fR \\fISIZE\\fR\n"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fB\\-\\-count\\fR \\fIINT\\fR\nHow many\n"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fB\\-j\\fR, \\fB\\-\\-json\\fR\nEvents as JSON\n"));
}

TEST_F(ManPage, LeavesNoTextToRoff) {
  const std::string page = man_page(root_, "");
  EXPECT_THAT(page, HasSubstr("Exit codes: 0 success.\n\\&.A line with a dot\n"));
  EXPECT_THAT(page, Not(HasSubstr(".SH SEE ALSO")));
}

}  // namespace
}  // namespace palpate::app
