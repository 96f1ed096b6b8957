// SPDX-License-Identifier: AGPL-3.0-or-later
// Which reader a file goes to, by its first bytes.
#include "fitting/measurement/records/table_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "format/error.hpp"
#include "format/hdf5_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::measured {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class TableFiles : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(file_, std::ios::binary) << text; }
  std::string refusal(const TableChoice& choice,
                      const std::vector<std::string>& wanted = {}) const {
    try {
      read_table(file_, choice, {}, wanted);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
  const samples::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "record";
};

TEST_F(TableFiles, OfTextAreReadWhateverTheirName) {
  write("x (mm),f (N)\n1,2\n2,3\n3,4\n");
  EXPECT_THAT(read_table(file_, {}, {}, {"f"}).columns[1].values, ElementsAre(2, 3, 4));
  EXPECT_THAT(refusal({0, "Run", ""}), HasSubstr("the file is no workbook"));
  EXPECT_THAT(refusal({0, "", "A1:B2"}), HasSubstr("no range of rows"));
  EXPECT_THAT(refusal({2, "", ""}), HasSubstr("no table 2"));
}

TEST_F(TableFiles, OfTextAreReadByRangesOfRows) {
  write("x (mm),f (N)\n1,2\n2,3\n3,4\n");
  const auto forces = [&](const char* range) {
    return read_table(file_, {0, "", range}, {}, {"f"}).columns[1].values;
  };
  EXPECT_THAT(forces("2:3"), ElementsAre(3, 4));
  EXPECT_THAT(forces("3:"), ElementsAre(4));
  EXPECT_THAT(forces(":2"), ElementsAre(2, 3));
  EXPECT_THAT(refusal({0, "", "2:4"}), HasSubstr("it has 3 rows of numbers"));
  EXPECT_THAT(refusal({0, "", "3:2"}), HasSubstr("it has 3 rows of numbers"));
  for (const char* range : {"2", "0:2", "1:2x", "-1:2"})
    EXPECT_THAT(refusal({0, "", range}), HasSubstr("no range of rows")) << range;
}

TEST_F(TableFiles, OfHdf5GiveTheColumnsThatAreNamed) {
  {
    hdf5::Writer writer(file_);
    writer.dataset("/x", std::vector<double>{1, 2, 3}, {"mm", "travel"});
    writer.dataset("/f_mN", std::vector<double>{4, 5, 6}, {"", "force"});
    writer.commit();
  }
  const CsvTable table = read_table(file_, {}, {}, {"/x", "/f_mN", "/x"});
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_THAT(column_in_si(table, "/x", Dimension::Length), ElementsAre(1e-3, 2e-3, 3e-3));
  EXPECT_THAT(column_in_si(table, "/f_mN", Dimension::Force), ElementsAre(4e-3, 5e-3, 6e-3));
  EXPECT_THAT(read_table(file_, {0, "", "2:"}, {}, {"/x"}).columns[0].values, ElementsAre(2, 3));
  EXPECT_THAT(refusal({1, "", ""}, {"/x"}), HasSubstr("name the columns by their paths"));
  EXPECT_THAT(refusal({}, {"/y"}), HasSubstr("there is no such data set"));
}

TEST_F(TableFiles, OfOldOrProtectedSpreadsheetsAreRefused) {
  write("\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1 and more");
  EXPECT_THAT(refusal({}), HasSubstr("save it as .xlsx without a password"));
}

TEST_F(TableFiles, ThatAreAbsentOrEmptyAreRefused) {
  EXPECT_THAT(refusal({}), HasSubstr("the record cannot be read"));
  write("");
  EXPECT_THAT(refusal({}), HasSubstr("the file is empty"));
}

}  // namespace
}  // namespace palpate::measured
