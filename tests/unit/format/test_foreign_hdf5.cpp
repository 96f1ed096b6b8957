// SPDX-License-Identifier: AGPL-3.0-or-later
// Files as other programs write them, with the bare HDF5 API.
#include "format/foreign_hdf5.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::hdf5 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Sample {
  float time;
  int count;
  double force;
};

class ForeignHdf5 : public testing::Test {
 protected:
  ForeignHdf5() : file_(folder_ / "run.h5") {
    const hid_t file = H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(H5Gcreate2(file, "run.1", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    write(file, "run.1/force", {4}, {1, 2, 3, 4}, "mN");
    write(file, "run.1/table", {3, 2}, {1, 10, 2, 20, 3, 30});
    write(file, "column", {3, 1}, {7, 8, 9});
    write(file, "cube", {2, 2, 2}, {1, 2, 3, 4, 5, 6, 7, 8});
    write(file, "gap", {3}, {1, std::nan(""), 3});
    write(file, "none", {0}, {});
    write_compound(file);
    write_matlab(file);
    write_odd(file);
    H5Fclose(file);
  }

  static void write(hid_t file, const char* name, const std::vector<hsize_t>& extent,
                    const std::vector<double>& values, const char* unit = nullptr) {
    const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
    const hid_t set =
        H5Dcreate2(file, name, H5T_STD_I32BE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t real = H5Dcreate2(file, (std::string(name) + " of reals").c_str(), H5T_IEEE_F64LE,
                                  space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (!values.empty()) {
      H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
      H5Dwrite(real, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    if (unit != nullptr) write_text(set, "units", unit);
    H5Dclose(real);
    H5Dclose(set);
    H5Sclose(space);
  }
  static void write_text(hid_t object, const char* name, const char* text) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, H5T_VARIABLE);
    const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, &text);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
  }
  static void write_compound(hid_t file) {
    const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Sample));
    H5Tinsert(type, "t", HOFFSET(Sample, time), H5T_NATIVE_FLOAT);
    H5Tinsert(type, "n", HOFFSET(Sample, count), H5T_NATIVE_INT);
    H5Tinsert(type, "F", HOFFSET(Sample, force), H5T_NATIVE_DOUBLE);
    const Sample samples[2] = {{0.5F, 1, -3.25}, {1.5F, 2, -4.25}};
    const hsize_t extent = 2;
    const hid_t space = H5Screate_simple(1, &extent, nullptr);
    const hid_t set = H5Dcreate2(file, "log", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, samples);
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
  }
  /// MATLAB stores the matrix [1 10; 2 20; 3 30] with its columns as rows.
  static void write_matlab(hid_t file) {
    write(file, "matrix", {2, 3}, {1, 2, 3, 10, 20, 30});
    write(file, "note", {1, 3}, {103, 101, 108});
    for (const auto& [name, kind] : {std::pair{"matrix", "double"}, {"note", "char"}}) {
      const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
      write_text(set, "MATLAB_class", kind);
      H5Dclose(set);
    }
  }
  static void write_odd(hid_t file) {
    const hsize_t extent = 2;
    const hid_t space = H5Screate_simple(1, &extent, nullptr), text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, 8);
    for (const auto& [name, type] :
         {std::pair{"names", text}, {"references", H5T_STD_REF_OBJ}, {"unwritten", H5T_IEEE_F64LE}})
      H5Dclose(H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    const hid_t outside = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_virtual(outside, space, "elsewhere.h5", "x", space);
    H5Dclose(H5Dcreate2(file, "virtual", H5T_IEEE_F64LE, space, H5P_DEFAULT, outside, H5P_DEFAULT));
    H5Lcreate_external("elsewhere.h5", "/x", file, "link", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/nowhere", file, "dangling", H5P_DEFAULT, H5P_DEFAULT);
    H5Pclose(outside);
    H5Sclose(space);
    H5Tclose(text);
  }

  std::vector<double> values(const std::string& path) const {
    return read_foreign_column(file_, path).values;
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
  const std::filesystem::path file_;
};

TEST_F(ForeignHdf5, ColumnsAreFoundByTheirPaths) {
  EXPECT_TRUE(is_hdf5(file_));
  EXPECT_THAT(values("/run.1/force"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(values("run.1/force"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(values("run.1.force"), ElementsAre(1, 2, 3, 4));  // as MATLAB writes it
  EXPECT_THAT(values("/run.1/force of reals"), ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(read_foreign_column(file_, "/run.1/force").unit, "mN");
  EXPECT_EQ(read_foreign_column(file_, "/column").unit, "");
  EXPECT_THAT(values("/column"), ElementsAre(7, 8, 9));
}

TEST_F(ForeignHdf5, ColumnsMayBePartsOfTables) {
  EXPECT_THAT(values("/run.1/table(:,2)"), ElementsAre(10, 20, 30));
  EXPECT_THAT(values("/run.1/table(3,:)"), ElementsAre(3, 30));
  EXPECT_THAT(values("/log.t"), ElementsAre(0.5, 1.5));
  EXPECT_THAT(values("/log.F"), ElementsAre(-3.25, -4.25));
  EXPECT_THAT(values("/log/n"), ElementsAre(1, 2));
  EXPECT_THAT(values("matrix(:,2)"), ElementsAre(10, 20, 30));
  EXPECT_THAT(values("matrix(2,:)"), ElementsAre(2, 20));
}

TEST_F(ForeignHdf5, AWrongPathIsAnsweredWithWhatIsThere) {
  EXPECT_THAT(refusal("/run.1/farce"), HasSubstr("there is no such data set"));
  EXPECT_THAT(refusal("/run.1/farce"), HasSubstr("'/run.1' holds 'force'"));
  EXPECT_THAT(refusal("/walk/force"), HasSubstr("the file holds 'column'"));
  EXPECT_THAT(refusal("/run.1"), HasSubstr("'/run.1' holds 'force'"));
  EXPECT_THAT(refusal(""), HasSubstr("the file holds"));
  EXPECT_THAT(refusal("/"), HasSubstr("the file holds"));
  EXPECT_THAT(refusal("/dangling"), HasSubstr("there is no such data set"));
  EXPECT_THAT(refusal("/link"), HasSubstr("there is no such data set"));
  EXPECT_THAT(refusal("/log.G"), HasSubstr("name one after a dot: 't', 'n', 'F'"));
  EXPECT_THAT(refusal("/log"), HasSubstr("a table of members"));
  EXPECT_THAT(refusal("/column.x"), HasSubstr("no members"));
}

TEST_F(ForeignHdf5, WhatIsNoColumnOfNumbersIsRefused) {
  EXPECT_THAT(refusal("/run.1/table"), HasSubstr("it is a table, not a column"));
  EXPECT_THAT(refusal("/run.1/table(:,3)"), HasSubstr("no column 3, the table has 2"));
  EXPECT_THAT(refusal("/run.1/force(:,1)"), HasSubstr("no table of rows and columns"));
  EXPECT_THAT(refusal("/cube"), HasSubstr("it is a table, not a column"));
  EXPECT_THAT(refusal("/cube(:,1)"), HasSubstr("no table of rows and columns"));
  EXPECT_THAT(refusal("/gap of reals"), HasSubstr("value 2 of 3 is NaN"));
  EXPECT_THAT(refusal("/none"), HasSubstr("it is empty"));
  EXPECT_THAT(refusal("/names"), HasSubstr("it holds texts"));
  EXPECT_THAT(refusal("/note"), HasSubstr("it holds texts"));
  EXPECT_THAT(refusal("/references"), HasSubstr("cells and arrays of structs of MATLAB"));
}

/// HDF5 reads zeros, with success, from both.
TEST_F(ForeignHdf5, WhatIsNotInTheFileIsNotReadAsZero) {
  EXPECT_THAT(refusal("/unwritten"), HasSubstr("never written"));
  EXPECT_THAT(refusal("/virtual"), HasSubstr("lie in other files"));
}

TEST_F(ForeignHdf5, AFileThatIsCutOffIsRefused) {
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  EXPECT_TRUE(is_hdf5(file_));
  EXPECT_THAT(refusal("/column"), HasSubstr("it may be cut off"));
  std::ofstream(folder_ / "text.h5") << "a,b\n1,2\n";
  EXPECT_FALSE(is_hdf5(folder_ / "text.h5"));
  EXPECT_FALSE(is_hdf5(folder_ / "absent.h5"));
}

}  // namespace
}  // namespace palpate::hdf5
