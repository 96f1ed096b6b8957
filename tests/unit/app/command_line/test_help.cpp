// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/command_line/help.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace palpate::app {
namespace {

std::size_t widest(const std::string& text) {
  std::istringstream lines(text);
  std::size_t most = 0;
  for (std::string line; std::getline(lines, line);) most = std::max(most, line.size());
  return most;
}

TEST(Help, FitsTheTerminalAndWithoutOneEightyColumns) {
  const std::string description =
      "Says so much that no terminal has room for it on one line, whatever its owner paid for the "
      "screen, and then some more, until it is as long as the longest of all descriptions is";
  for (const auto& [columns, most] : {std::pair{0, 80}, std::pair{100, 100}, std::pair{60, 60}}) {
    CLI::App root{"root"};
    root.formatter(help_formatter(columns));
    CLI::App* command = root.add_subcommand("command", description);
    command->add_flag("--flag", description);
    for (const std::string& help : {root.help(), command->help()}) {
      EXPECT_LE(widest(help), static_cast<std::size_t>(most)) << help;
      EXPECT_GT(widest(help), static_cast<std::size_t>(most) - 20) << help;
    }
  }
}

}  // namespace
}  // namespace palpate::app
