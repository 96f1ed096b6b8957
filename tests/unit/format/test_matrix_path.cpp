// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/matrix_path.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "format/error.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

std::string path_refusal(const std::string& path) {
  try {
    matrix_path(path, "here");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MatrixPath, TakesAColumnOrARowFromTheEnd) {
  const MatrixPath column = matrix_path("/run(2).data( :, 12 )", "");
  EXPECT_EQ(column.base, "/run(2).data");
  EXPECT_EQ(column.column, 12);
  EXPECT_EQ(column.row, 0);
  const MatrixPath row = matrix_path("data(3,:)", "");
  EXPECT_EQ(row.base, "data");
  EXPECT_EQ(row.row, 3);
  EXPECT_FALSE(matrix_path("run(2)", "").chosen());
  EXPECT_EQ(matrix_path("run(2)", "").base, "run(2)");
  EXPECT_EQ(matrix_path("Load (N)", "").base, "Load (N)");
  EXPECT_EQ(matrix_path("", "").base, "");
  EXPECT_EQ(matrix_path("(:,1)", "").base, "(:,1)");
}

TEST(MatrixPath, IsRefusedWhereItChoosesNoLine) {
  for (const char* path : {"a(:,0)", "a(:,-1)", "a(:,x)", "a(:,)", "a(:,:)", "a(:,99999999999)"})
    EXPECT_THAT(path_refusal(path), HasSubstr("is no column or row")) << path;
  EXPECT_THAT(path_refusal("a(1,2)"), HasSubstr("neither a column nor a row"));
}

TEST(MatrixPath, ValuesAreFiniteOrRefusedByTheirNumber) {
  const auto refusal_of = [](double value) -> std::string {
    try {
      check_finite({1, 2, value, 4}, "here");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal_of(3), "accepted");
  EXPECT_THAT(refusal_of(std::numeric_limits<double>::quiet_NaN()),
              HasSubstr("value 3 of 4 is NaN"));
  EXPECT_THAT(refusal_of(-std::numeric_limits<double>::infinity()), HasSubstr("is infinite"));
}

}  // namespace
}  // namespace palpate
