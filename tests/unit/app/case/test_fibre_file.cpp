// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/fibre_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

class FibreFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "palpate-fibres-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& text) const {
    std::ofstream(folder_ / "fibres.csv") << text;
    return folder_ / "fibres.csv";
  }
  std::string message(const std::string& text) const {
    try {
      read_fibre_file(write(text), 1);
    } catch (const Error& error) {
      return error.what();
    }
    return "read";
  }

  fs::path folder_;
};

TEST_F(FibreFile, ReadsPointsInTheirUnitAndDirections) {
  const auto samples = read_fibre_file(
      write("# from a scan\nx,y,z,fx,fy,fz,sx,sy,sz\n\n1, 2, 3, 0, 0, 2, 1, 0, 0  # first\n"
            "-1e1,0,0.5,1,0,0,0,1,0\r\n"),
      1e-3);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_DOUBLE_EQ(samples[0].at[1], 0.002);
  EXPECT_DOUBLE_EQ(samples[1].at[0], -0.010);
  EXPECT_EQ(samples[0].mean, (Vec3{0, 0, 2}));
  EXPECT_EQ(samples[1].across, (Vec3{0, 1, 0}));
  const auto without = read_fibre_file(write("x,y,z,fx,fy,fz\n1,2,3,0,0,2\n"), 1);
  EXPECT_EQ(without[0].across, (Vec3{0, 0, 0}));
}

TEST_F(FibreFile, NamesTheLineAndTheProblem) {
  using testing::AllOf;
  using testing::HasSubstr;
  const std::string title = "x,y,z,fx,fy,fz\n";
  EXPECT_THAT(message("a,b\n"), AllOf(HasSubstr(":1"), HasSubstr("unknown columns 'a,b'")));
  EXPECT_THAT(message(""), HasSubstr("unknown columns ''"));
  EXPECT_THAT(message(title), HasSubstr("no points"));
  EXPECT_THAT(message(title + "1,2,3,1,0,0\n1,2,3,1,0\n"),
              AllOf(HasSubstr(":3"), HasSubstr("5 values for 6 columns")));
  EXPECT_THAT(message(title + "1,2,3,1,0,0,7\n"), HasSubstr("7 values for 6 columns"));
  EXPECT_THAT(message(title + "1,2,mm,1,0,0\n"), HasSubstr("value 3 is not a finite number"));
  EXPECT_THAT(message(title + "1,2,nan,1,0,0\n"), HasSubstr("value 3 is not a finite number"));
  EXPECT_THAT(message(title + "1,2,3,0,0,0\n"), AllOf(HasSubstr(":2"), HasSubstr("is zero")));
  EXPECT_THAT(message("x,y,z,fx,fy,fz,sx,sy,sz\n1,2,3,0,0,1,0,0,2\n"), HasSubstr("parallel"));
  EXPECT_THROW(read_fibre_file(folder_ / "none.csv", 1), Error);
}

}  // namespace
}  // namespace palpate::app
