// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/file/scanner.hpp"

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

TEST(Scanner, NumbersFillTheirWord) {
  EXPECT_EQ(real_of("+1.5e-3"), 1.5e-3);
  EXPECT_EQ(real_of(".5"), 0.5);
  EXPECT_EQ(real_of("7."), 7.0);
  EXPECT_EQ(integer_of("-12"), -12);
  for (const char* word : {"", "1.5x", "+-1", "x", "1 2"})
    EXPECT_EQ(real_of(word), std::nullopt) << word;
  for (const char* word : {"1.5", "9223372036854775808"})
    EXPECT_EQ(integer_of(word), std::nullopt) << word;
}

TEST(Scanner, WordsAndLinesKnowTheirPlace) {
  Scanner scanner("one two\r\n\n  three\nrest of it\nend", "a.txt");
  EXPECT_EQ(scanner.word(), "one");
  EXPECT_EQ(scanner.peek(), "two");
  EXPECT_EQ(scanner.where(), "a.txt:1");
  EXPECT_EQ(scanner.word(), "two");
  EXPECT_EQ(scanner.word(), "three");
  EXPECT_EQ(scanner.where(), "a.txt:3");
  EXPECT_EQ(scanner.line(), "");
  EXPECT_EQ(scanner.line(), "rest of it");
  EXPECT_EQ(scanner.where(), "a.txt:4");
  EXPECT_EQ(scanner.line(), "end");
  EXPECT_EQ(scanner.line(), std::nullopt);
  EXPECT_EQ(scanner.word(), "");
}

TEST(Scanner, CountsAreNoLargerThanWhatFollows) {
  Scanner fits("3\n1 2 3", "a.txt");
  EXPECT_EQ(fits.count("the number of rows", 2), 3U);
  Scanner huge("1000000000000000000\n1 2 3", "a.txt");
  expect_refusal([&] { huge.count("the number of rows", 2); }, "a.txt:1",
                 "the number of rows is 1000000000000000000, more than the 6 bytes");
  Scanner negative("-1\n1 2 3", "a.txt");
  expect_refusal([&] { negative.count("the number of rows", 2); }, "a.txt:1", "is -1");
}

TEST(Scanner, BinaryValuesOfEitherByteOrder) {
  const std::string bytes{'\0', '\0', '\1', '\2', '\2', '\1', '\0', '\0'};
  Scanner scanner(bytes, "a.bin");
  EXPECT_EQ(scanner.binary<std::int32_t>("a number", true), 258);
  EXPECT_EQ(scanner.binary<std::int32_t>("a number"), 258);
  expect_refusal([&] { scanner.binary<double>("a number"); }, "a.bin:byte 8", "inside a number");
}

TEST(Fields, AreSeparatedByBlanksOrCommas) {
  const Scanner place("", "a.txt");
  Fields blanks("  1 \t 2.5 ", place);
  EXPECT_EQ(blanks.integer("a number"), 1);
  EXPECT_EQ(blanks.real("a number"), 2.5);
  EXPECT_TRUE(blanks.at_end());
  Fields commas("1,, two words ,", place, ',');
  EXPECT_EQ(commas.next(), "1");
  EXPECT_EQ(commas.next(), "");
  EXPECT_EQ(commas.next(), "two words");
  EXPECT_TRUE(commas.at_end());
  expect_refusal([&] { commas.real("a coordinate"); }, "a.txt", "the line ends where a coordinate");
}

}  // namespace
}  // namespace palpate::mesher
