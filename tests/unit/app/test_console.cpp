// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/console.hpp"

#include <gtest/gtest.h>

#include <string>

namespace palpate::app {
namespace {

TEST(Console, MarksErrorsAndWarningsInFront) {
  EXPECT_EQ(error_line("no such file", false), "error: no such file");
  EXPECT_EQ(warning_line("a hole was filled", false), "warning: a hole was filled");
  EXPECT_EQ(error_line("two\nlines", false), "error: two lines");
}

TEST(Console, ColoursTheMarkAlone) {
  EXPECT_EQ(error_line("text", true), "\x1b[1;31merror:\x1b[0m text");
  EXPECT_EQ(warning_line("text", true), "\x1b[1;33mwarning:\x1b[0m text");
}

TEST(Console, FitsABarToTheTerminal) {
  const std::string text = "precompute: 12 of 238 sites, 0 incomplete, 3 min 07 s left";
  for (const int columns : {200, 100, 80, 72, 60, 40, 10, 2}) {
    const std::string line = bar_line(0.5, text, columns);
    EXPECT_LT(line.size(), static_cast<std::size_t>(columns)) << line;  // the last column wraps
    EXPECT_FALSE(line.empty());
  }
  EXPECT_EQ(bar_line(0.5, text, 0), "[###############...............] " + text);
  EXPECT_EQ(bar_line(0.5, text, 200), "[###############...............] " + text);
  EXPECT_EQ(bar_line(0.5, text, 80), "[#########.........] " + text);
  EXPECT_EQ(bar_line(0.5, text, 60), text);
  EXPECT_EQ(bar_line(1, "done", 40), "[##############################] done");
}

}  // namespace
}  // namespace palpate::app
