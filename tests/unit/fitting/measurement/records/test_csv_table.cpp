// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "fitting/measurement/records/csv_table.hpp"
#include "format/error.hpp"

namespace palpate::measured {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(std::string_view text, const std::vector<DeclaredColumn>& declared = {}) {
  try {
    parse_csv(text, "a.csv", declared);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "accepted";
}

std::string unit_refusal(const CsvTable& table, const std::string& name, Dimension dimension,
                         const std::string& declared = {}) {
  try {
    column_in_si(table, name, dimension, declared);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

/// Bluehill: a preamble of quoted keys and values, names, units in brackets, quoted numbers.
TEST(Csv, ReadsBluehill) {
  const CsvTable table = parse_csv(
      "\xEF\xBB\xBF\"Specimen label\",\"gel 3\"\r\n\"Width\",\"12.5\",\"mm\"\r\n\r\n"
      "\"Time\",\"Compressive extension\",\"Load\"\r\n\"(s)\",\"(mm)\",\"(N)\"\r\n"
      "\"0.000\",\"0.000\",\"-0.010\"\r\n\"0.100\",\"0.020\",\"0.000\"\r\n"
      "\"0.200\",\"0.040\",\"0.010\"\r\n\r\n",
      "a.csv");
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.columns[1].name, "Compressive extension");
  EXPECT_EQ(table.columns[1].unit, "mm");
  EXPECT_THAT(table.preamble,
              ElementsAre("\"Specimen label\",\"gel 3\"", "\"Width\",\"12.5\",\"mm\""));
  EXPECT_EQ(table.first_data_line, 6U);
  EXPECT_THAT(column_in_si(table, "Compressive extension", Dimension::Length),
              ElementsAre(0.0, 0.02e-3, 0.04e-3));
}

/// MTS: tabs, bare units in their row.
TEST(Csv, ReadsMts) {
  const CsvTable table = parse_csv(
      "MTS793|MPT|ENU|1|0|.|/|:|1|0|0|A\n\nData Header:\tTime:\t10.5\tSec\n"
      "Axial Displacement\tAxial Force\tRunning Time\nmm\tN\ts\n"
      "-1\t0.5\t0\n-1.5\t0.75\t0.5\n-2\t1\t1\n",
      "a.txt");
  EXPECT_THAT(column_in_si(table, "Axial Force", Dimension::Force), ElementsAre(0.5, 0.75, 1));
  EXPECT_THAT(column_in_si(table, "Axial Displacement", Dimension::Length),
              ElementsAre(-0.001, -0.0015, -0.002));
}

TEST(Csv, ReadsDecimalCommas) {
  const CsvTable table =
      parse_csv("Weg / mm;Kraft / mN\n0,5;1000\n1,0;2000,5\n1,5;3000\n", "a.csv");
  EXPECT_THAT(column_in_si(table, "Kraft", Dimension::Force), ElementsAre(1, 2.0005, 3));
}

TEST(Csv, ReadsDecimalCommasBetweenBlanks) {
  const CsvTable table = parse_csv("Weg/mm Kraft/mN\n0,5 1000\n1,0 2000,5\n1,5 3000\n", "a.txt");
  EXPECT_THAT(column_in_si(table, "Kraft", Dimension::Force), ElementsAre(1, 2.0005, 3));
}

TEST(Csv, ReadsUnitsBesideTheNames) {
  for (const char* header : {"x (mm),f (N)", "x [mm],f [N]", "x / mm,f / N", "x in mm,f in N",
                             "\"x, mm\",\"f, N\"", "x_mm,f_N"}) {
    const CsvTable table = parse_csv(std::string(header) + "\n1,2\n3,4\n5,6\n", "a.csv");
    EXPECT_THAT(column_in_si(table, "x", Dimension::Length), ElementsAre(1e-3, 3e-3, 5e-3))
        << header;
    EXPECT_THAT(column_in_si(table, "f", Dimension::Force), ElementsAre(2, 4, 6)) << header;
  }
}

/// Separated by tabs, the unit after a comma, blocks in angle brackets: as Mach-1 testers write it.
TEST(Csv, ReadsUnitsAfterACommaBetweenTabs) {
  const CsvTable table = parse_csv(
      "<DATA>\nTime, s\tPosition (z), mm\tFz, N\n0.01\t1.5\t-0.002\n0.02\t1.6\t-0.003\n"
      "0.03\t1.7\t-0.004\n<END DATA>\n",
      "a.txt");
  EXPECT_THAT(column_in_si(table, "Time", Dimension::Time), ElementsAre(0.01, 0.02, 0.03));
  EXPECT_THAT(column_in_si(table, "Position (z)", Dimension::Length),
              ElementsAre(1.5e-3, 1.6e-3, 1.7e-3));
  EXPECT_THAT(column_in_si(table, "Fz", Dimension::Force), ElementsAre(-0.002, -0.003, -0.004));
}

TEST(Csv, ReadsFilesWithoutHeaderWhenDeclared) {
  const std::string text = "0 1e-3\n1 2e-3\n2 3e-3\n";
  EXPECT_THAT(refusal(text), HasSubstr("the table has no header; declare the columns"));
  const CsvTable table = parse_csv(text, "a.txt", {{"x", "mm"}, {"f", "N"}});
  EXPECT_THAT(column_in_si(table, "x", Dimension::Length), ElementsAre(0, 1e-3, 2e-3));
  EXPECT_THAT(refusal(text, {{"x", "mm"}}), HasSubstr("1 columns are declared, the table has 2"));
}

/// The raw data of several specimens below each other, each under its own header.
TEST(Csv, ReadsOneOfSeveralTables) {
  const std::string text =
      "\"Operator\",\"A\"\r\n\"Specimen\",\"1\"\r\n\"Time\",\"Extension\",\"Load\"\r\n"
      "\"(s)\",\"(mm)\",\"(N)\"\r\n0,0,1\r\n1,1,2\r\n2,2,3\r\n\r\n"
      "\"Specimen\",\"2\"\r\n\"Time\",\"Extension\",\"Load\"\r\n\"(s)\",\"(mm)\",\"(kN)\"\r\n"
      "0,0,4\r\n1,1,5\r\n2,2,6\r\n3,3,7\r\n\r\n\r\n";
  EXPECT_THAT(refusal(text), HasSubstr("it holds 2 tables; choose one with `table` = 1 to 2"));
  const CsvTable first = parse_csv(text, "a.csv", {}, 1), second = parse_csv(text, "a.csv", {}, 2);
  EXPECT_THAT(column_in_si(first, "Load", Dimension::Force), ElementsAre(1, 2, 3));
  EXPECT_THAT(column_in_si(second, "Load", Dimension::Force), ElementsAre(4e3, 5e3, 6e3, 7e3));
  EXPECT_THAT(second.preamble, ElementsAre("\"Specimen\",\"2\""));
  EXPECT_THROW(parse_csv(text, "a.csv", {}, 3), Error);
  // A header that lost a name is none: the file is refused at it, whichever table is asked for.
  EXPECT_THAT(refusal("x (mm),f (N)\n1,2\n3,4\n5,6\nx (mm)\n1,2\n3,4\n5,6\n"),
              HasSubstr("a.csv:5: field 1 ('x (mm)') is not a number"));
}

/// Digits in groups, where it is unmistakable which mark is the decimal sign.
TEST(Csv, ReadsGroupedDigits) {
  const auto values = [](const std::string& text) {
    return column_in_si(parse_csv(text, "a.csv"), "f", Dimension::Force);
  };
  EXPECT_THAT(values("x (mm);f (N)\n1;999.5\n2;1,234.5\n3;-1,234,567.25\n"),
              ElementsAre(999.5, 1234.5, -1234567.25));
  EXPECT_THAT(values("\"x (mm)\",\"f (N)\"\n\"1\",\"999.5\"\n\"2\",\"1,234.5\"\n\"3\",\"2\"\n"),
              ElementsAre(999.5, 1234.5, 2));
  EXPECT_THAT(values("x (mm);f (N)\n1,0;999,5\n2,0;1.234,5\n3,0;-12.345,25\n"),
              ElementsAre(999.5, 1234.5, -12345.25));
  EXPECT_THAT(values("x (mm);f (N)\n1;1 234\n2;1'234,5\n3;1\xC2\xA0"
                     "234\xC2\xA0"
                     "567,5\n4;1\xE2\x80\xAF"
                     "234\n"),
              ElementsAre(1234, 1234.5, 1234567.5, 1234));
  // Three digits after a comma are decimals, wherever the file leaves no other reading.
  EXPECT_THAT(values("x (mm);f (N)\n1,0;0,500\n2,0;1,234\n3,0;10,000\n"),
              ElementsAre(0.5, 1.234, 10));
  EXPECT_THAT(refusal("x (mm);f (N)\n1;999.5\n2;1000.5\n3;1100.5\n4;1,234\n"),
              HasSubstr("a.csv:5: field 2 ('1,234') is not a number"));
  EXPECT_THAT(refusal("x (mm);f (N)\n1;99.5\n2;10.5\n3;11.5\n4;12,34.5\n"),
              HasSubstr("('12,34.5') is not a number"));
}

/// Headers in the encodings that spreadsheets and machines write.
TEST(Csv, ReadsOtherEncodings) {
  const std::string name =
      "Pr\xC3\xBC"
      "fweg";
  const auto is_read = [&](const std::string& text) {
    const CsvTable table = parse_csv(text, "a.csv");
    EXPECT_THAT(column_in_si(table, name, Dimension::Length), ElementsAre(1e-6, 2e-6, 3e-6));
  };
  is_read(name + " / \xC2\xB5m;f / N\n1;1\n2;1\n3;1\n");
  is_read(
      "Pr\xFC"
      "fweg / \xB5m;f / N\r\n1;1\r\n2;1\r\n3;1\r\n");
  std::string little = "\xFF\xFE", big = "\xFE\xFF";
  for (const char c : std::string("Pr\xFC"
                                  "fweg [\xB5m]\tf [N]\r\n1\t1\r\n2\t1\r\n3\t1\r\n")) {
    little += c;
    little += '\0';
    big += '\0';
    big += c;
  }
  is_read(little);
  is_read(big);
}

TEST(Csv, NeverSkipsARow) {
  EXPECT_THAT(refusal("x (mm),f (N)\n1,2\n3,4\n5,6\n7,####\n8,9\n"),
              HasSubstr("a.csv:5: field 2 ('####') is not a number"));
  EXPECT_THAT(refusal("x (mm),f (N)\n1,2\n3,nan\n5,6\n7,8\n9,10\n"),
              HasSubstr("a.csv:3: field 2 ('nan') is not a number"));
  EXPECT_THAT(refusal("x (mm),f (N)\n1,2\n3,4\n5,6\n7,8,9\n"),
              HasSubstr("a.csv:5: the row has 3 fields, 2 expected"));
  EXPECT_THAT(refusal("x (mm),f (N)\n1,2\n3,4\n5,6\nSpecimen 2\n1,2\n3,4\n"),
              HasSubstr("a.csv:5: field 1 ('Specimen 2') is not a number"));
  EXPECT_THAT(refusal("x (mm),f (N),t (s)\n1,2\n3,4\n5,6\n"),
              HasSubstr("a.csv:1: the header has 3 names for 2 columns"));
  EXPECT_THAT(refusal("\"x (mm)\",\"f (N)\"\n\"1\",\"2\"\n\"3\",\"4\"\n\"5\",\"6\"\n\"7\",\"0.0"),
              HasSubstr("a.csv:5: the row ends within quotes; the file was cut off"));
  EXPECT_THAT(refusal("\"x (mm)\",\"f (N)\"\n\"1\",\"2\"\n\"3\",\"4\"\n\"5\",\"6\"\n\"7\",\"\"\n"),
              HasSubstr("a.csv:5: field 2 is empty"));
  EXPECT_THAT(refusal("nothing here\n"), HasSubstr("no table of numbers"));
  EXPECT_THAT(refusal("a,b\n1,2\n3,4\n"), HasSubstr(":2: the table has 2 rows of numbers"));
  EXPECT_THAT(refusal("a,b,c\n1,2,S0\n3,4,S0\n5,6,S0\n"), HasSubstr(":2: 'S0' is not a number"));
  EXPECT_THAT(refusal(""), HasSubstr("no table of numbers"));
}

TEST(Csv, TellsAnEmptyFileFromOneThatIsNotThere) {
  const auto path = std::filesystem::path(testing::TempDir()) / "palpate-empty.csv";
  std::ofstream(path).close();
  const auto refusal_of = [](const std::filesystem::path& file) {
    try {
      read_csv(file);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal_of(path), HasSubstr("the file is empty"));
  std::filesystem::remove(path);
  EXPECT_THAT(refusal_of(path), HasSubstr("the record cannot be read"));
}

TEST(Csv, NeverAssumesAUnit) {
  const CsvTable table = parse_csv("x,f (N),g (furlong)\n1,2,0\n3,4,0\n5,6,0\n", "a.csv");
  EXPECT_THAT(unit_refusal(table, "x", Dimension::Length), HasSubstr("its unit is not given"));
  EXPECT_EQ(unit_refusal(table, "x", Dimension::Length, "mm"), "accepted");
  EXPECT_THAT(unit_refusal(table, "f", Dimension::Force, "mN"),
              HasSubstr("the file says 'N', the sidecar says 'mN'"));
  EXPECT_THAT(unit_refusal(table, "f", Dimension::Length),
              HasSubstr("'N' is not a unit of length"));
  EXPECT_THAT(unit_refusal(table, "g", Dimension::Length), HasSubstr("'furlong' is not a unit"));
  EXPECT_THAT(unit_refusal(table, "y", Dimension::Length),
              HasSubstr("no column is named 'y'; the columns are 'x', 'f', 'g'"));
}

}  // namespace
}  // namespace palpate::measured
