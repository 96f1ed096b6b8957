// SPDX-License-Identifier: AGPL-3.0-or-later
// Workbooks as openpyxl writes them, and others bent by hand.
#include "fitting/measurement/records/workbook.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "fitting/measurement/records/table_file.hpp"
#include "format/error.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/fitting/measurement/records/workbook_writer.hpp"

namespace palpate::measured {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Workbooks : public testing::Test {
 protected:
  void write(const std::vector<std::pair<std::string, std::string>>& sheets) const {
    write_archive(file_, workbook_members(sheets));
  }
  CsvTable read(const TableChoice& choice = {}) const { return read_table(file_, choice, {}, {}); }
  std::string refusal(const TableChoice& choice = {}) const {
    try {
      read(choice);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      return error.what();
    }
    return "accepted";
  }

  const samples::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "a.xlsx";
  const std::string header_ = row_of(1, {"x (mm)", "F (N)"});
  const std::string rows_ =
      row_of(2, {"0", "0.5"}) + row_of(3, {"1", "-1.25"}) + row_of(4, {"2", "3"});
};

/// Made by openpyxl 3.0.9: shared texts, a preamble, a row of units, a second sheet, an empty one.
TEST_F(Workbooks, OfOpenpyxlAreRead) {
  const auto file = test::source_folder() / "tests/data/records/openpyxl.xlsx";
  EXPECT_TRUE(is_zip(file));
  const CsvTable table = read_table(file, {0, "Press 1", ""}, {}, {});
  EXPECT_THAT(table.preamble, ElementsAre("Specimen\tgel \xC3\xA4", "Operator\tA. B."));
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.columns[0].name, "Time");
  EXPECT_EQ(table.columns[2].name, "Load");
  EXPECT_EQ(table.columns[2].unit, "mN");
  EXPECT_EQ(table.first_data_line, 7U);
  ASSERT_EQ(table.columns[2].values.size(), 20U);
  EXPECT_DOUBLE_EQ(table.columns[1].values[19], 1.9);
  EXPECT_DOUBLE_EQ(table.columns[2].values[19], 0.1 * 19 * 19);
  EXPECT_THAT(column_in_si(read_table(file, {0, "two", "C2:D5"}, {}, {}), "f", Dimension::Force),
              ElementsAre(1, 2, 3));
}

TEST_F(Workbooks, HaveOneSheetOrAChosenOne) {
  write({{"Sheet1", ""}, {"Run", header_ + rows_}, {"Sheet3", ""}});
  EXPECT_THAT(read().columns[1].values, ElementsAre(0.5, -1.25, 3));
  EXPECT_EQ(read().columns[1].unit, "N");
  EXPECT_THAT(read().file, HasSubstr("a.xlsx, sheet 'Run'"));
  write({{"Run", header_ + rows_}, {"Other", header_ + rows_}});
  EXPECT_THAT(refusal(), HasSubstr("several sheets; choose one with `sheet`: 'Run', 'Other'"));
  EXPECT_EQ(refusal({0, "Other", ""}), "accepted");
  EXPECT_THAT(refusal({0, "Othre", ""}),
              HasSubstr("no sheet 'Othre'; its sheets are 'Run', 'Other'"));
}

TEST_F(Workbooks, HaveARange) {
  const std::string noted = header_ + row_of(2, {"0", "0.5", "", "touched here"}) +
                            row_of(3, {"1", "-1.25"}) + row_of(4, {"2", "3"}) +
                            row_of(6, {"mean", "0.75"});
  write({{"Run", noted}});
  EXPECT_THAT(refusal(), HasSubstr("a.xlsx, sheet 'Run':"));
  EXPECT_THAT(read({0, "", "A1:B4"}).columns[1].values, ElementsAre(0.5, -1.25, 3));
  EXPECT_THAT(refusal({0, "", "B1:B4"}), HasSubstr("no table of numbers"));
  EXPECT_THAT(refusal({0, "", "F1:G4"}), HasSubstr("no cell of F1:G4 is filled"));
  for (const char* range : {"A1", "B1:A4", "A4:B1", "A:B4", "1:4", "AAAAA1:B2", "a1:b4", "A0:B4"})
    EXPECT_THAT(refusal({0, "", range}), HasSubstr("is not a range of cells")) << range;
  write({{"Run", header_ + rows_ + row_of(9, {"", "", "", "a note"})}});
  EXPECT_THAT(read({0, "", "A:B"}).columns[0].values, ElementsAre(0, 1, 2));
}

/// The row of the sheet is named, and what stands in the cell.
TEST_F(Workbooks, CellsThatAreNoNumbersAreRefused) {
  const auto with_cell = [&](const std::string& cell) {
    write({{"Run", header_ + rows_ + "<row r=\"5\"><c r=\"A5\"><v>3</v></c>" + cell + "</row>" +
                       row_of(6, {"4", "5"})}});
    return refusal();
  };
  EXPECT_THAT(with_cell("<c r=\"B5\" t=\"inlineStr\"><is><t>n/a</t></is></c>"),
              HasSubstr("sheet 'Run':5: field 2 ('n/a') is not a number"));
  EXPECT_THAT(with_cell("<c r=\"B5\" t=\"e\"><v>#DIV/0!</v></c>"), HasSubstr("'#DIV/0!'"));
  EXPECT_THAT(with_cell("<c r=\"B5\" t=\"b\"><v>1</v></c>"), HasSubstr("'TRUE'"));
  EXPECT_THAT(with_cell("<c r=\"B5\"><f>A5*2</f></c>"), HasSubstr("a formula without a value"));
  EXPECT_THAT(with_cell("<c r=\"B5\" t=\"s\"><v>99</v></c>"), HasSubstr("a text that is missing"));
  EXPECT_THAT(with_cell("<c r=\"B5\"><v>NaN</v></c>"), HasSubstr("('NaN') is not a number"));
  EXPECT_THAT(with_cell(""), HasSubstr("sheet 'Run':5: the row has 1 fields, 2 expected"));
  EXPECT_EQ(with_cell("<c r=\"B5\"><f>A5*2</f><v>6</v></c>"), "accepted");
}

/// A day of 24 h is 1, and 5 % are 0.05: neither is a number of the unit above it.
TEST_F(Workbooks, DatesAndPercentagesAreNotTakenForNumbers) {
  const auto with_format = [&](const std::string& formats, int id) {
    auto members =
        workbook_members({{"Run", header_ + rows_ +
                                      "<row r=\"5\"><c r=\"A5\"><v>3</v></c><c r=\"B5\" s=\"1\"><v>"
                                      "0.05</v></c></row>"}});
    members["xl/styles.xml"] = "<styleSheet>" + formats +
                               "<cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"" + std::to_string(id) +
                               "\"/></cellXfs></styleSheet>";
    write_archive(file_, members);
    return refusal();
  };
  const auto with_code = [&](const std::string& code) {
    return with_format("<numFmts><numFmt numFmtId=\"164\" formatCode=\"" + code + "\"/></numFmts>",
                       164);
  };
  EXPECT_THAT(with_format("", 10), HasSubstr("0.05 in percent format"));
  EXPECT_THAT(with_format("", 14), HasSubstr("0.05 as a date or time"));
  EXPECT_THAT(with_format("", 46), HasSubstr("0.05 as a date or time"));
  EXPECT_EQ(with_format("", 2), "accepted");
  EXPECT_THAT(with_code("[h]:mm"), HasSubstr("as a date or time"));
  EXPECT_THAT(with_code("yyyy-mm-dd"), HasSubstr("as a date or time"));
  EXPECT_THAT(with_code("0.00%"), HasSubstr("in percent format"));
  EXPECT_EQ(with_code("0.00 &quot;days&quot;"), "accepted");
  EXPECT_EQ(with_code("[Red]0.00E+00"), "accepted");
}

TEST_F(Workbooks, ThatAreEmptyDamagedOrNoneAreRefused) {
  write({{"Run", ""}});
  EXPECT_THAT(refusal(), HasSubstr("no sheet has cells"));
  EXPECT_THAT(refusal({0, "Run", ""}), HasSubstr("sheet 'Run': it has no cells"));
  write_archive(file_, {{"content.xml", "<x/>"}});
  EXPECT_THAT(refusal(), HasSubstr("no workbook of Excel"));
  auto members = workbook_members({{"Run", header_ + rows_}});
  members["xl/worksheets/sheet1.xml"].resize(80);
  write_archive(file_, members);
  EXPECT_THAT(refusal(), HasSubstr("xl/worksheets/sheet1.xml"));
  members.erase("xl/worksheets/sheet1.xml");
  write_archive(file_, members);
  EXPECT_THAT(refusal(), HasSubstr("no sheet has cells"));
  write({{"Run", header_ + rows_}});
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 30);
  EXPECT_THAT(refusal(), HasSubstr("it was cut off"));
  // Rows beyond the largest sheet are none.
  write({{"Run", row_of(2000000, {"1", "2"})}});
  EXPECT_THAT(refusal(), HasSubstr("no sheet has cells"));
}

}  // namespace
}  // namespace palpate::measured
