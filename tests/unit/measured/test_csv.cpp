// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/measured/csv_table.hpp"
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

std::string unit_refusal(const CsvTable& table, const std::string& name, Quantity quantity,
                         const std::string& declared = {}) {
  try {
    column_in_si(table, name, quantity, declared);
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
  EXPECT_THAT(column_in_si(table, "Compressive extension", Quantity::Length),
              ElementsAre(0.0, 0.02e-3, 0.04e-3));
}

/// MTS: tabs, bare units in their row.
TEST(Csv, ReadsMts) {
  const CsvTable table = parse_csv(
      "MTS793|MPT|ENU|1|0|.|/|:|1|0|0|A\n\nData Header:\tTime:\t10.5\tSec\n"
      "Axial Displacement\tAxial Force\tRunning Time\nmm\tN\ts\n"
      "-1\t0.5\t0\n-1.5\t0.75\t0.5\n-2\t1\t1\n",
      "a.txt");
  EXPECT_THAT(column_in_si(table, "Axial Force", Quantity::Force), ElementsAre(0.5, 0.75, 1));
  EXPECT_THAT(column_in_si(table, "Axial Displacement", Quantity::Length),
              ElementsAre(-0.001, -0.0015, -0.002));
}

TEST(Csv, ReadsDecimalCommas) {
  const CsvTable table =
      parse_csv("Weg / mm;Kraft / mN\n0,5;1000\n1,0;2000,5\n1,5;3000\n", "a.csv");
  EXPECT_THAT(column_in_si(table, "Kraft", Quantity::Force), ElementsAre(1, 2.0005, 3));
}

TEST(Csv, ReadsUnitsBesideTheNames) {
  for (const char* header :
       {"x (mm),f (N)", "x [mm],f [N]", "x / mm,f / N", "x in mm,f in N", "x_mm,f_N"}) {
    const CsvTable table = parse_csv(std::string(header) + "\n1,2\n3,4\n5,6\n", "a.csv");
    EXPECT_THAT(column_in_si(table, "x", Quantity::Length), ElementsAre(1e-3, 3e-3, 5e-3))
        << header;
    EXPECT_THAT(column_in_si(table, "f", Quantity::Force), ElementsAre(2, 4, 6)) << header;
  }
}

TEST(Csv, ReadsFilesWithoutHeaderWhenDeclared) {
  const std::string text = "0 1e-3\n1 2e-3\n2 3e-3\n";
  EXPECT_THAT(refusal(text), HasSubstr("the table has no header; declare the columns"));
  const CsvTable table = parse_csv(text, "a.txt", {{"x", "mm"}, {"f", "N"}});
  EXPECT_THAT(column_in_si(table, "x", Quantity::Length), ElementsAre(0, 1e-3, 2e-3));
  EXPECT_THAT(refusal(text, {{"x", "mm"}}), HasSubstr("1 columns are declared, the table has 2"));
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
  EXPECT_THAT(refusal("nothing here\n"), HasSubstr("no table of numbers"));
  EXPECT_THAT(refusal(""), HasSubstr("no table of numbers"));
}

TEST(Csv, NeverAssumesAUnit) {
  const CsvTable table = parse_csv("x,f (N),g (furlong)\n1,2,0\n3,4,0\n5,6,0\n", "a.csv");
  EXPECT_THAT(unit_refusal(table, "x", Quantity::Length), HasSubstr("its unit is not given"));
  EXPECT_EQ(unit_refusal(table, "x", Quantity::Length, "mm"), "accepted");
  EXPECT_THAT(unit_refusal(table, "f", Quantity::Force, "mN"),
              HasSubstr("the file says 'N', the sidecar says 'mN'"));
  EXPECT_THAT(unit_refusal(table, "f", Quantity::Length), HasSubstr("'N' is not a unit of length"));
  EXPECT_THAT(unit_refusal(table, "g", Quantity::Length), HasSubstr("'furlong' is not a unit"));
  EXPECT_THAT(unit_refusal(table, "y", Quantity::Length),
              HasSubstr("no column is named 'y'; the columns are 'x', 'f', 'g'"));
}

TEST(Csv, KnowsTheUnitsOfLaboratories) {
  EXPECT_NEAR(*unit_in_si("lbf", Quantity::Force), 4.4482216152605, 1e-12);
  EXPECT_NEAR(*unit_in_si("kgf", Quantity::Force), 9.80665, 1e-12);
  EXPECT_NEAR(*unit_in_si("psi", Quantity::Stress), 6894.757293168, 1e-6);
  for (const char* micro : {"um", "\xC2\xB5m", "\xCE\xBCm", "\xB5m"}) {
    EXPECT_NEAR(*unit_in_si(micro, Quantity::Length), 1e-6, 1e-18);
  }
  EXPECT_FALSE(unit_in_si("N", Quantity::Length));
}

}  // namespace
}  // namespace palpate::measured
