// SPDX-License-Identifier: AGPL-3.0-or-later
// Records of tests as machines and authors deliver them, read through the keys of a fit file.
#include "app/calibrate/specimen_record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "app/calibrate/fit_file.hpp"
#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SpecimenRecords : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  calibrate::HomogeneousTest read(const std::string& keys) const {
    write(
        "fit.toml",
        "name = \"a\"\nsource = \"b\"\nlicence = \"c\"\n[fit]\nlaw = \"neo-hookean\"\n[[test]]\n" +
            keys);
    const FitFile file = read_fit_file(folder_ / "fit.toml");
    statement_ = file.statements.at(0);
    return file.tests.at(0);
  }
  std::string refusal(const std::string& keys) const {
    try {
      read(keys);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }

  samples::TemporaryFolder folder_;
  mutable std::string statement_;
};

/// Published tables: bare numbers, deformation and stress in a file each.
TEST_F(SpecimenRecords, MayBeBareColumnsInTwoFiles) {
  write("stretch.txt", "1.5\n2.5\n3.5\n4\n");
  write("stress.txt", "0.25\n0.75\n1.5\n2\n");
  const auto test = read(
      "file = \"stretch.txt\"\ncolumns = [\"l\"]\nstress_file = \"stress.txt\"\nmode = "
      "\"uniaxial\"\n"
      "deformation = \"l\"\ndeformation_unit = \"1\"\nstress = \"P\"\nstress_unit = \"MPa\"\n");
  EXPECT_THAT(test.deformation, ElementsAre(1.5, 2.5, 3.5, 4));
  EXPECT_THAT(test.nominal, ElementsAre(250e3, 750e3, 1500e3, 2e6));
  write("stress.txt", "0.25\n0.75\n1.5\n");
  EXPECT_THAT(refusal("file = \"stretch.txt\"\ncolumns = [\"l\"]\nstress_file = \"stress.txt\"\n"
                      "mode = \"uniaxial\"\ndeformation = \"l\"\ndeformation_unit = \"1\"\n"
                      "stress = \"P\"\nstress_unit = \"MPa\"\n"),
              HasSubstr("4 deformations do not go with 3 stresses"));
  write("stress.txt", "0.25\nstress\n0.75\n1.5\n");
  EXPECT_THAT(refusal("file = \"stretch.txt\"\ncolumns = [\"l\"]\nstress_file = \"stress.txt\"\n"
                      "mode = \"uniaxial\"\ndeformation = \"l\"\ndeformation_unit = \"1\"\n"
                      "stress = \"P\"\nstress_unit = \"MPa\"\n"),
              HasSubstr("stress.txt:2: it is not one number"));
}

/// Strain in percent, positive in compression as testing machines count it.
TEST_F(SpecimenRecords, HaveStrainsOfEitherSign) {
  write("press.csv", "strain (%),stress (kPa)\n10,1\n20,3\n30,7\n");
  const std::string keys =
      "file = \"press.csv\"\nmode = \"uniaxial\"\ndeformation = \"strain\"\nstress = \"stress\"\n"
      "deformation_sign = \"reversed\"\nstress_sign = \"reversed\"\n";
  auto test = read(keys + "deformation_is = \"strain\"\n");
  EXPECT_NEAR(test.deformation[1], 0.8, 1e-12);
  EXPECT_THAT(test.nominal, ElementsAre(-1e3, -3e3, -7e3));
  test = read(keys + "deformation_is = \"log strain\"\nmeasure = \"cauchy\"\n");
  EXPECT_NEAR(test.deformation[1], std::exp(-0.2), 1e-12);
  EXPECT_NEAR(test.nominal[1], -3e3 / std::exp(-0.2), 1e-9);
  EXPECT_THAT(refusal(keys + "deformation_is = \"shear\"\n"), HasSubstr("uniaxial is not a shear"));
}

/// Travel and force of a round specimen: F/A and 1 + x/L, from the first row that is used.
TEST_F(SpecimenRecords, HaveTravelAndForceOfASpecimen) {
  write("pull.csv", "time (s),x (mm),F (mN)\n0,40,0\n1,50,2\n2,51,4\n3,52,6\n4,60,9\n");
  const std::string keys =
      "file = \"pull.csv\"\nmode = \"uniaxial\"\ndisplacement = \"x\"\nforce = \"F\"\n"
      "first_row = 2\nlast_row = 4\nzero = \"first row\"\n";
  const auto test = read(keys + "gauge_length = \"20 mm\"\ndiameter = \"4 mm\"\n");
  const double area = std::numbers::pi * 4e-6;
  ASSERT_EQ(test.deformation.size(), 3U);
  EXPECT_NEAR(test.deformation[0], 1, 1e-12);
  EXPECT_NEAR(test.deformation[2], 1.1, 1e-12);
  EXPECT_NEAR(test.nominal[2], 6e-3 / area, 1e-9);
  EXPECT_NEAR(read(keys + "gauge_length = \"20 mm\"\narea = \"12.5 mm^2\"\n").nominal[2],
              6e-3 / 12.5e-6, 1e-9);
  EXPECT_THAT(refusal(keys + "diameter = \"4 mm\"\n"), HasSubstr("give gauge_length"));
  EXPECT_THAT(refusal(keys + "gauge_length = \"2 cm\"\n"), HasSubstr("needs the section"));
  EXPECT_THAT(refusal(keys + "gauge_length = \"2 cm\"\narea = \"3 mm\"\n"),
              HasSubstr("'3 mm' is not an area"));
  EXPECT_THAT(refusal(keys + "gauge_length = \"2 cm\"\narea = \"3 mm^2\"\ndiameter = \"1 mm\"\n"),
              HasSubstr("once"));
  EXPECT_THAT(refusal("file = \"pull.csv\"\nmode = \"uniaxial\"\ndisplacement = \"x\"\n"
                      "force = \"F\"\ngauge_length = \"2 cm\"\narea = \"3 mm^2\"\nlast_row = 9\n"),
              HasSubstr("5 rows of numbers, not 1 to 9"));
}

/// Tension that a machine counts downwards, and compression that it counts upwards.
TEST_F(SpecimenRecords, AreOfTheLoadThatIsStated) {
  write("down.csv", "x (mm),F (mN)\n0,0\n-1,-2\n-2,-4\n-3,-6\n");
  const std::string keys =
      "file = \"down.csv\"\nmode = \"uniaxial\"\ndisplacement = \"x\"\nforce = \"F\"\n"
      "gauge_length = \"20 mm\"\narea = \"10 mm^2\"\n";
  EXPECT_NEAR(read(keys).deformation[3], 0.85, 1e-12);  // without a load, as recorded
  const auto pull = read(keys + "load = \"tension\"\n");
  EXPECT_NEAR(pull.deformation[3], 1.15, 1e-12);
  EXPECT_NEAR(pull.nominal[3], 600, 1e-9);
  write("down.csv", "x (mm),F (mN)\n0,0\n1,2\n2,4\n3,6\n");
  const auto press = read(keys + "load = \"compression\"\n");
  EXPECT_NEAR(press.deformation[3], 0.85, 1e-12);
  EXPECT_NEAR(press.nominal[3], -600, 1e-9);
  EXPECT_EQ(statement_, "stretch = 1 - x/(20.0 mm), nominal stress = -F/(10 mm^2)");
  EXPECT_THAT(refusal(keys + "load = \"tension\"\nstress_sign = \"reversed\"\n"),
              HasSubstr("both a load and signs"));
  write("down.csv", "x (mm),F (mN)\n-2,-4\n0,0\n2,4\n3,6\n");
  EXPECT_THAT(refusal(keys + "load = \"tension\"\n"), HasSubstr("both sides of rest"));
  write("l.csv", "l (1),P (Pa)\n1,0\n1.1,20\n1.2,40\n");
  const std::string stretch =
      "file = \"l.csv\"\nmode = \"uniaxial\"\ndeformation = \"l\"\nstress = \"P\"\n";
  EXPECT_THAT(refusal(stretch + "load = \"compression\"\n"),
              HasSubstr("stretches that reach 1.2 are no compression"));
  EXPECT_EQ(refusal(stretch + "load = \"tension\"\n"), "accepted");
  EXPECT_THAT(refusal("file = \"l.csv\"\nmode = \"simple shear\"\ndeformation = \"l\"\n"
                      "stress = \"P\"\nload = \"tension\"\n"),
              HasSubstr("neither tension nor compression"));
}

/// Two cycles with noise at their turns, the second table of a file.
TEST_F(SpecimenRecords, HaveCyclesAndTables) {
  std::string text = "a (1),P (Pa)\n1,2\n3,4\n5,6\n7,8\n\nstretch (1),P (Pa)\n";
  const auto add = [&](double s, int P) {
    text += std::to_string(s) + "," + std::to_string(P) + "\n";
  };
  for (const int height : {5, 10})
    for (int i = 0; i < 2 * height; ++i) {
      const int up = i <= height ? i : 2 * height - i;
      add(1 + 0.02 * up - (i == height / 2 ? 0.01 : 0), 100 * height + i);
    }
  write("cycles.csv", text);
  const std::string keys =
      "file = \"cycles.csv\"\ntable = 2\nmode = \"equibiaxial\"\ndeformation = \"stretch\"\n"
      "stress = \"P\"\n";
  EXPECT_EQ(read(keys).nominal.size(), 30U);
  EXPECT_THAT(statement_, HasSubstr("nominal stress = P, all 2 cycles"));
  const auto loading = read(keys + "cycle = 2\nbranch = \"loading\"\n");
  EXPECT_EQ(loading.nominal.front(), 1000);
  EXPECT_EQ(loading.nominal.back(), 1010);
  const auto unloading = read(keys + "cycle = -1\nbranch = \"unloading\"\n");
  EXPECT_THAT(statement_, HasSubstr(", cycle 2 of 2"));
  EXPECT_EQ(unloading.nominal.front(), 1010);
  EXPECT_EQ(unloading.nominal.back(), 1019);
  const auto both = read(keys + "cycle = 1\n");
  EXPECT_EQ(both.nominal.front(), 500);
  EXPECT_EQ(both.nominal.back(), 1000);
  EXPECT_THAT(refusal(keys + "cycle = 3\n"), HasSubstr("has 2 cycles, and no cycle 3"));
  EXPECT_THAT(refusal(keys + "branch = \"loading\"\n"), HasSubstr("give cycle"));
}

TEST_F(SpecimenRecords, MayHaveAnOffset) {
  write("a.csv", "s (1),P (Pa)\n1.1,2\n1.2,4\n1.3,6\n");
  const std::string keys =
      "file = \"a.csv\"\nmode = \"pure shear\"\ndeformation = \"s\"\nstress = \"P\"\n";
  EXPECT_FALSE(read(keys).offset);
  EXPECT_TRUE(read(keys + "offset = true\n").offset);
}

/// |sin|: the branches end at its peaks and zeros.
TEST(Branches, EndAtTheTurns) {
  std::vector<double> s;
  for (int i = 0; i <= 400; ++i)
    s.push_back(1 + std::abs(std::sin(i * std::numbers::pi / 100)) + 0.05 * (i % 2));
  const auto branches = branches_of(s, 1);
  ASSERT_EQ(branches.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(branches[i].loading, i % 2 == 0);
    EXPECT_NEAR(static_cast<double>(branches[i].last), 50.0 * static_cast<double>(i + 1), 5);
  }
  EXPECT_TRUE(branches_of({1.0}, 1).empty());
}

}  // namespace
}  // namespace palpate::app
