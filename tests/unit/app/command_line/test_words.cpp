// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/command_line/words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace palpate::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Words = std::vector<std::string>;

/// A command line with the shapes that palpate has: subcommands, subcommands of one, options with
/// and without a value, options of all.
class CommandWords : public ::testing::Test {
 protected:
  CommandWords() {
    root_.add_flag("-q,--quiet");
    CLI::App* build = root_.add_subcommand("build", "");
    build->add_option("CASE", case_);
    build->add_option("--out", out_);
    build->add_option("--threads", threads_);
    CLI::App* exported = root_.add_subcommand("export", "");
    exported->add_option("--style", out_);
    exported->add_subcommand("site", "")->add_flag("--json");
    exported->add_subcommand("recording", "");
  }

  std::string unknown(const Words& words) const { return unknown_word(root_, words); }

  CLI::App root_{"", "palpate"};

 private:
  std::string case_, out_;
  int threads_ = 0;
};

TEST_F(CommandWords, TakesWhatTheParserTakes) {
  EXPECT_THAT(unknown({}), IsEmpty());
  EXPECT_THAT(unknown({"build", "liver.toml", "--out", "o", "--threads=2", "--quiet"}), IsEmpty());
  EXPECT_THAT(unknown({"--quiet", "build", "--help"}), IsEmpty());
  EXPECT_THAT(unknown({"export", "site", "--json"}), IsEmpty());
  EXPECT_THAT(unknown({"export", "--style", "none", "site"}), IsEmpty());
  EXPECT_THAT(unknown({"build", "--", "--strange.toml"}), IsEmpty());
}

TEST_F(CommandWords, NamesTheNearestWord) {
  EXPECT_EQ(unknown({"biuld"}), "unknown subcommand 'biuld'; the nearest is 'build'");
  EXPECT_EQ(unknown({"export", "sites"}), "unknown subcommand 'sites'; the nearest is 'site'");
  EXPECT_EQ(unknown({"build", "l.toml", "--thread=2"}),
            "unknown option '--thread'; the nearest is '--threads'");
  EXPECT_EQ(unknown({"build", "l.toml", "--quite"}),
            "unknown option '--quite'; the nearest is '--quiet'");
  EXPECT_EQ(unknown({"export", "site", "--jsn"}),
            "unknown option '--jsn'; the nearest is '--json'");
}

/// The beginning of a word is meant for it, however much is missing.
TEST_F(CommandWords, TakesABeginningForTheWholeWord) {
  EXPECT_EQ(unknown({"build", "l.toml", "--thr"}),
            "unknown option '--thr'; the nearest is '--threads'");
  EXPECT_EQ(unknown({"export", "rec"}), "unknown subcommand 'rec'; the nearest is 'recording'");
}

TEST_F(CommandWords, NamesTheHelpOfTheCommandWhereNoWordIsNear) {
  EXPECT_EQ(unknown({"build", "--absolutely"}),
            "unknown option '--absolutely'; see 'palpate help build'");
  EXPECT_EQ(unknown({"export", "site", "--absolutely"}),
            "unknown option '--absolutely'; see 'palpate help export site'");
  EXPECT_EQ(unknown({"whatever"}), "unknown subcommand 'whatever'; see 'palpate help'");
}

TEST_F(CommandWords, ExplainTheCommandThatWasParsed) {
  EXPECT_EQ(help_for(root_), "palpate help");
  EXPECT_THROW(root_.parse("export site --jsn"), CLI::ParseError);
  EXPECT_EQ(help_for(root_), "palpate help export site");
}

TEST_F(CommandWords, TurnsHelpIntoAnOption) {
  EXPECT_THAT(help_as_option({"help"}), ElementsAre("--help"));
  EXPECT_THAT(help_as_option({"help", "export", "site"}), ElementsAre("export", "site", "--help"));
  EXPECT_THAT(help_as_option({"build", "help"}), ElementsAre("build", "help"));
  EXPECT_EQ(unknown(help_as_option({"help", "exprot"})),
            "unknown subcommand 'exprot'; the nearest is 'export'");
}

}  // namespace
}  // namespace palpate::app
