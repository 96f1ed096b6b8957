// SPDX-License-Identifier: AGPL-3.0-or-later
// The script is run by bash.
#include "app/command_line/completion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

class Completion : public ::testing::Test {
 protected:
  Completion() {
    root_.add_flag("-q,--quiet");
    CLI::App* build = root_.add_subcommand("build", "");
    build->add_option("CASE", text_);
    build->add_option("--out", text_);
    CLI::App* exported = root_.add_subcommand("export", "");
    exported->add_subcommand("site", "")->add_flag("--json");
    exported->add_subcommand("recording", "");
    std::ofstream(script_) << bash_completion(root_);
  }

  /// What bash offers after these words, one blank between the offers.
  std::string offers(const std::string& words) const {
    const std::string ask = "source " + script_ + "; COMP_WORDS=(palpate " + words +
                            "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _palpate; "
                            "echo \"${COMPREPLY[@]}\"";
    const std::unique_ptr<FILE, int (*)(FILE*)> bash(
        popen(("bash --norc -c '" + ask + "'").c_str(), "r"), pclose);
    std::array<char, 1024> line{};
    if (!bash || std::fgets(line.data(), line.size(), bash.get()) == nullptr) return "bash failed";
    std::string text = line.data();
    text.erase(text.find_last_not_of('\n') + 1);
    return text;
  }

 private:
  CLI::App root_{"", "palpate"};
  std::string text_;
  samples::TemporaryFolder folder_;
  std::string script_ = (folder_ / "palpate.bash").string();
};

TEST_F(Completion, OffersSubcommands) {
  EXPECT_EQ(offers("\"\""), "build export");
  EXPECT_EQ(offers("bu"), "build");
  EXPECT_EQ(offers("export \"\""), "site recording");
  EXPECT_EQ(offers("--quiet export r"), "recording");
}

TEST_F(Completion, OffersOptionsOfTheCommandAndOfAll) {
  EXPECT_EQ(offers("build --"), "--help --out --quiet");
  EXPECT_EQ(offers("build case.toml --o"), "--out");
  EXPECT_EQ(offers("export site --j"), "--json");
  EXPECT_EQ(offers("--qu"), "--quiet");
}

TEST_F(Completion, LeavesFilesToBash) {
  EXPECT_EQ(offers("build ca"), "");
}

}  // namespace
}  // namespace palpate::app
