// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/wrapped_text.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace palpate::app {
namespace {

TEST(WrappedText, BreaksBetweenWordsAndIndentsWhatFollows) {
  EXPECT_EQ(wrapped("  one two three four", 12, 2), "  one two\n    three\n    four");
  EXPECT_EQ(wrapped("one two\nthree four five", 10, 2), "one two\nthree four\n  five");
}

TEST(WrappedText, KeepsWhatFits) {
  const std::string table = "  name    value\n  a           1\n";
  EXPECT_EQ(wrapped(table, 15, 2), table);
  EXPECT_EQ(wrapped(table, 0, 2), table);
  EXPECT_EQ(wrapped("", 10, 2), "");
}

TEST(WrappedText, KeepsAWordThatIsWiderThanTheLine) {
  EXPECT_EQ(wrapped("see /a/very/long/path/library.h5 there", 10, 2),
            "see\n  /a/very/long/path/library.h5\n  there");
  EXPECT_EQ(wrapped("/a/very/long/path", 10, 2), "/a/very/long/path");
}

TEST(WrappedText, LosesNoWordAtAnyWidth) {
  const std::string text = "  12 of 238 sites ended early, 3 of them without a response (usable)";
  for (std::size_t columns = 1; columns < 80; ++columns) {
    std::istringstream whole(text), broken(wrapped(text, columns, 2));
    for (std::string a, b; whole >> a;) {
      ASSERT_TRUE(broken >> b);
      EXPECT_EQ(a, b) << columns;
    }
  }
}

TEST(WrappedText, CountsLettersInsteadOfBytes) {
  EXPECT_EQ(wrapped("\x1b[1;31merror:\x1b[0m abc", 10, 2), "\x1b[1;31merror:\x1b[0m abc");
  EXPECT_EQ(wrapped("\xc3\xa4\xc3\xb6\xc3\xbc abc", 7, 2), "\xc3\xa4\xc3\xb6\xc3\xbc abc");
}

TEST(WrappedText, HelpGoesOnBelowTheDescription) {
  EXPECT_EQ(
      wrapped_help("  --a       one two three\nusage: a b c d e f\n  palpate b --out c", 17, 12),
      "  --a       one\n            two\n            three\nusage: a b c d e\n  f\n"
      "  palpate b --out\n    c");
}

}  // namespace
}  // namespace palpate::app
