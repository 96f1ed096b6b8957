// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/measurement/records/csv_text.hpp"

namespace palpate::measured {
namespace {

using testing::ElementsAre;

TEST(CsvText, HasUtf8OfEveryEncoding) {
  const std::string umlaut = "\xC3\xBC";
  EXPECT_EQ(as_utf8("\xEF\xBB\xBF" + umlaut), umlaut);
  EXPECT_EQ(as_utf8(umlaut), umlaut);
  EXPECT_EQ(as_utf8("\xFC"), umlaut);  // Latin-1
  EXPECT_EQ(as_utf8(std::string("\xFF\xFE\xFC\x00", 4)), umlaut);
  EXPECT_EQ(as_utf8(std::string("\xFE\xFF\x00\xFC", 4)), umlaut);
}

TEST(CsvText, LinesAreCountedWithTheBlankOnes) {
  const auto lines = lines_of("a\r\n\r\nb");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].number, 1U);
  EXPECT_EQ(lines[1].number, 3U);
  EXPECT_EQ(lines[1].text, "b");
}

TEST(CsvText, FieldsMayBeQuotedAndLinesMayEndInASeparator) {
  EXPECT_THAT(split("a, \"b,c\" ,d,", ','), ElementsAre("a", "b,c", "d"));
  EXPECT_THAT(split("a;;d", ';'), ElementsAre("a", "", "d"));
  EXPECT_THAT(split("  1 \t 2", kBlanks), ElementsAre("1", "2"));
}

TEST(CsvText, NumbersHaveOneReading) {
  EXPECT_EQ(number_of("+1.5e-3", '.'), 1.5e-3);
  EXPECT_EQ(number_of("-1,5", ','), -1.5);
  EXPECT_EQ(number_of("1,234.5", '.'), 1234.5);
  EXPECT_EQ(number_of("1.234,5", ','), 1234.5);
  EXPECT_EQ(number_of("1 234", '.'), 1234);
  for (const char* text : {"", "1,234", "12,34.5", "nan", "inf", "1e999", "1.5x"})
    EXPECT_FALSE(number_of(text, '.')) << text;
  EXPECT_FALSE(number_of("1.5", ','));
}

}  // namespace
}  // namespace palpate::measured
