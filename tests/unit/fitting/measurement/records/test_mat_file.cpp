// SPDX-License-Identifier: AGPL-3.0-or-later
// MAT files of version 5, as libmatio writes them after the format of MATLAB.
#include "fitting/measurement/records/mat_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "fitting/measurement/records/table_file.hpp"
#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::measured {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

matvar_t* array_of(const char* name, std::array<std::size_t, 2> dims, std::vector<double> values) {
  return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims.data(), values.data(), 0);
}

class MatFiles : public testing::Test {
 protected:
  MatFiles() { write(file_, MAT_FT_MAT5, MAT_COMPRESSION_ZLIB); }

  static void write(const std::filesystem::path& path, mat_ft version, matio_compression packed) {
    mat_t* file = Mat_CreateVer(path.c_str(), nullptr, version);
    const auto put = [&](matvar_t* variable) {
      Mat_VarWrite(file, variable, packed);
      Mat_VarFree(variable);
    };
    put(array_of("force_mN", {4, 1}, {1, 2, 3, 4}));
    put(array_of("row", {1, 3}, {7, 8, 9}));
    put(array_of("data", {3, 2}, {1, 2, 3, 10, 20, 30}));  // column by column
    put(array_of("gap", {3, 1}, {1, std::nan(""), 3}));
    put(array_of("none", {0, 0}, {}));
    std::array<std::size_t, 2> four{1, 4};
    std::string note = "gel!";
    std::array<std::int16_t, 4> counts{-1, 2, -3, 4};
    put(Mat_VarCreate("counts", MAT_C_INT16, MAT_T_INT16, 2, four.data(), counts.data(), 0));
    put(Mat_VarCreate("note", MAT_C_CHAR, MAT_T_UINT8, 2, four.data(), note.data(), 0));
    put(structs());
    put(cells());
    Mat_Close(file);
  }

  /// run(1).press.force = [1 2 3]', run(2).press.force = [10 20 30]'
  static matvar_t* structs() {
    constexpr std::array<const char*, 2> outer{"name", "press"};
    constexpr std::array<const char*, 1> inner{"force"};
    std::array<std::size_t, 2> two{1, 2}, one{1, 1};
    matvar_t* run =
        Mat_VarCreateStruct("run", 2, two.data(), const_cast<const char**>(outer.data()), 2);
    for (std::size_t i = 0; i < 2; ++i) {
      matvar_t* press =
          Mat_VarCreateStruct("press", 2, one.data(), const_cast<const char**>(inner.data()), 1);
      const double scale = i == 0 ? 1 : 10;
      Mat_VarSetStructFieldByName(press, "force", 0,
                                  array_of("force", {3, 1}, {scale, 2 * scale, 3 * scale}));
      Mat_VarSetStructFieldByName(run, "press", i, press);
      Mat_VarSetStructFieldByName(run, "name", i, array_of("name", {1, 1}, {0}));
    }
    return run;
  }
  static matvar_t* cells() {
    std::array<std::size_t, 2> two{1, 2};
    matvar_t* list[2] = {array_of("a", {3, 1}, {1, 2, 3}), array_of("b", {3, 1}, {4, 5, 6})};
    return Mat_VarCreate("cells", MAT_C_CELL, MAT_T_CELL, 2, two.data(), list, 0);
  }

  std::vector<double> values(const std::string& path) const {
    return read_table(file_, {}, {}, {path}).columns.at(0).values;
  }
  std::string refusal(const std::string& path) const {
    try {
      values(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      return error.what();
    }
    return "accepted";
  }

  const samples::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "run.mat";
};

TEST_F(MatFiles, ColumnsAreFoundAsMatlabWritesThem) {
  EXPECT_TRUE(is_mat_file(file_));
  EXPECT_THAT(values("force_mN"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(values("row"), ElementsAre(7, 8, 9));
  EXPECT_THAT(values("data(:,2)"), ElementsAre(10, 20, 30));
  EXPECT_THAT(values("data(2,:)"), ElementsAre(2, 20));
  EXPECT_THAT(values("counts"), ElementsAre(-1, 2, -3, 4));
  EXPECT_THAT(values("run(2).press.force"), ElementsAre(10, 20, 30));
  EXPECT_THAT(values("/run(1)/press/force"), ElementsAre(1, 2, 3));
  EXPECT_THAT(values("cells{2}"), ElementsAre(4, 5, 6));
}

/// No header is at hand: the unit may stand in the name of the variable.
TEST_F(MatFiles, UnitsStandInNamesOrAreDeclared) {
  EXPECT_EQ(read_table(file_, {}, {}, {"force_mN"}).columns[0].unit, "mN");
  EXPECT_EQ(read_table(file_, {}, {}, {"data(:,1)"}).columns[0].unit, "");
  EXPECT_EQ(read_table(file_, {}, {{"data(:,1)", "um"}}, {"data(:,1)"}).columns[0].unit, "um");
  EXPECT_EQ(read_table(file_, {}, {{"force_mN", "uN"}}, {"force_mN"}).columns[0].unit, "uN");
}

TEST_F(MatFiles, AWrongPathIsAnsweredWithWhatIsThere) {
  EXPECT_THAT(refusal("farce"), HasSubstr("no variable 'farce'"));
  EXPECT_THAT(refusal("farce"), HasSubstr("'force_mN', 'row', 'data'"));
  EXPECT_THAT(refusal("run(2).press.farce"), HasSubstr("no field 'farce'; the struct has 'force'"));
  EXPECT_THAT(refusal("run.press.force"), HasSubstr("an array of 2 structs; choose one"));
  EXPECT_THAT(refusal("run(3).press.force"), HasSubstr("no element 3, the array has 2"));
  EXPECT_THAT(refusal("run(0).press.force"), HasSubstr("no path of MATLAB"));
  EXPECT_THAT(refusal("run(1).press"), HasSubstr("name one of its fields: 'force'"));
  EXPECT_THAT(refusal("row.x"), HasSubstr("what has the field 'x' is no struct"));
  EXPECT_THAT(refusal("row{1}"), HasSubstr("no cell array"));
  EXPECT_THAT(refusal("row(2)"), HasSubstr("no path of MATLAB"));
  EXPECT_THAT(refusal("cells"), HasSubstr("choose a cell"));
  EXPECT_THAT(refusal("cells{3}"), HasSubstr("no element 3"));
  for (const char* path : {"run(", "run(2", "(2)", ".", "run..x", "run{a}"})
    EXPECT_THAT(refusal(path), HasSubstr("no path of MATLAB")) << path;
}

TEST_F(MatFiles, WhatIsNoColumnOfNumbersIsRefused) {
  EXPECT_THAT(refusal("data"), HasSubstr("a matrix, not a column; choose a column: data(:,1)"));
  EXPECT_THAT(refusal("data(:,3)"), HasSubstr("no column 3, the matrix has 2"));
  EXPECT_THAT(refusal("data(4,:)"), HasSubstr("no row 4, the matrix has 3"));
  EXPECT_THAT(refusal("gap"), HasSubstr("value 2 of 3 is NaN"));
  EXPECT_THAT(refusal("none"), HasSubstr("it is empty"));
  EXPECT_THAT(refusal("note"), HasSubstr("it holds text"));
}

TEST_F(MatFiles, ThatAreCutOffAreRefused) {
  write(file_, MAT_FT_MAT5, MAT_COMPRESSION_NONE);
  const auto whole = std::filesystem::file_size(file_);
  for (const auto size :
       {whole / 2, std::uintmax_t{200}, std::uintmax_t{130}, std::uintmax_t{60}}) {
    std::filesystem::resize_file(file_, size);
    EXPECT_NE(refusal("cells{1}"), "accepted") << size;
    EXPECT_THAT(refusal("cells{1}"), HasSubstr("cut off")) << size;
    write(file_, MAT_FT_MAT5, MAT_COMPRESSION_NONE);
  }
}

/// Version 7.3 is HDF5, its matrices transposed and its structs groups.
TEST_F(MatFiles, OfVersion73AreReadByTheSamePaths) {
  write(file_, MAT_FT_MAT73, MAT_COMPRESSION_NONE);
  EXPECT_THAT(values("force_mN"), ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(read_table(file_, {}, {}, {"force_mN"}).columns[0].unit, "mN");
  EXPECT_THAT(values("data(:,2)"), ElementsAre(10, 20, 30));
  EXPECT_THAT(values("data(2,:)"), ElementsAre(2, 20));
  EXPECT_THAT(refusal("data"), HasSubstr("it is a table, not a column"));
  EXPECT_NE(refusal("farce"), "accepted");
  EXPECT_NE(refusal("note"), "accepted");
}

}  // namespace
}  // namespace palpate::measured
