// SPDX-License-Identifier: AGPL-3.0-or-later
// One section of a sidecar for many files.
#include "app/measured/many_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "app/measured/sidecar.hpp"
#include "format/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

class ManyFiles : public testing::Test {
 protected:
  ManyFiles() {
    for (const char* name : {"run-10-20-1.csv", "run-10-20-2.csv", "run-5-7.5-1.csv"})
      std::ofstream(folder_ / name) << "x\n";
  }
  Sidecar read(const std::string& sections) const {
    std::ofstream(folder_ / "a.toml")
        << "name = \"a\"\nspecimen = \"b\"\nsource = \"c\"\nlicence = \"d\"\n"
           "[tool]\nradius = \"6 mm\"\nfriction = \"no-slip\"\n"
           "[columns]\ndisplacement = \"X\"\nforce = \"F\"\n"
        << sections;
    return read_sidecar(folder_ / "a.toml");
  }
  std::string refusal(const std::string& sections) const {
    try {
      read(sections);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
  const samples::TemporaryFolder folder_;
};

TEST_F(ManyFiles, VaryByTheirNames) {
  const Sidecar sidecar = read(
      "[[press]]\nfiles = \"run-{x}-{y}-*.csv\"\nsite_from = [\"{x} mm\", \"{y} mm\", \"2 cm\"]\n");
  ASSERT_EQ(sidecar.presses.size(), 3U);
  EXPECT_EQ(sidecar.presses[0].file, "run-5-7.5-1.csv");
  EXPECT_EQ(sidecar.presses[0].site, (Vec3{5e-3, 7.5e-3, 20e-3}));
  EXPECT_EQ(sidecar.presses[2].file, "run-10-20-2.csv");
  EXPECT_EQ(sidecar.presses[2].site, (Vec3{10e-3, 20e-3, 20e-3}));
  const Sidecar sheets = read(
      "[[press]]\nfiles = \"run-{v}-20-{n}.csv\"\nvertex_from = \"{v}\"\nsheet = \"Run {n}\"\n"
      "cycle_from = \"-{n}\"\n");
  ASSERT_EQ(sheets.presses.size(), 2U);
  EXPECT_EQ(sheets.presses[1].vertex, 10);
  EXPECT_EQ(sheets.presses[1].choice.sheet, "Run 2");
  EXPECT_EQ(sheets.presses[1].cycle, -2);
}

TEST_F(ManyFiles, VaryByAList) {
  std::ofstream(folder_ / "sites.csv") << "name,vertex,touch\n10-20-1,7,0.25\n5-7.5-1,9,0.5\n";
  const Sidecar sidecar = read(
      "[contact]\nmethod = \"given\"\n[[press]]\nlist = \"sites.csv\"\nfile = \"run-{name}.csv\"\n"
      "vertex_from = \"{vertex}\"\ncontact_from = \"{touch} mm\"\n");
  ASSERT_EQ(sidecar.presses.size(), 2U);
  EXPECT_EQ(sidecar.presses[1].file, "run-5-7.5-1.csv");
  EXPECT_EQ(sidecar.presses[1].vertex, 9);
  EXPECT_EQ(sidecar.presses[1].contact, 0.5e-3);
}

TEST_F(ManyFiles, LogsOfRobotsMayBeMany) {
  const std::string columns =
      "x = \"x\"\ny = \"y\"\nz = \"z\"\nfx = \"u\"\nfy = \"v\"\nfz = \"w\"\n";
  EXPECT_EQ(read(columns + "[[robot]]\nfiles = \"run-10-*.csv\"\n").robot_logs.size(), 2U);
  EXPECT_THAT(refusal(columns + "[[robot]]\ncycle = 1\n"), HasSubstr("it names no log"));
}

TEST_F(ManyFiles, AreRefusedWhereTheyAreNotClear) {
  const std::string all = "[[press]]\nfiles = \"run-{x}-{y}-{n}.csv\"\n";
  EXPECT_THAT(refusal(all), HasSubstr("neither vertex nor site"));
  EXPECT_THAT(refusal(all + "vertex_from = \"{z}\"\n"), HasSubstr("known are {n}, {x}, {y}"));
  EXPECT_THAT(refusal(all + "vertex_from = \"{y}\"\n"),
              HasSubstr("(run-5-7.5-1.csv): '7.5' is not a whole number"));
  EXPECT_THAT(refusal(all + "vertex_from = \"-{n}\"\n"), HasSubstr("the vertex is negative"));
  EXPECT_THAT(refusal(all + "site_from = [\"{x}\", \"{y}\", \"1\"]\n"),
              HasSubstr("not a length with its unit"));
  EXPECT_THAT(refusal(all + "site_from = [\"{x} mm\"]\n"), HasSubstr("three coordinates"));
  EXPECT_THAT(refusal(all + "file = \"a.csv\"\nvertex = 1\n"),
              HasSubstr("both a file and a pattern"));
  EXPECT_THAT(refusal(all + "list = \"l.csv\"\nvertex = 1\n"),
              HasSubstr("both a pattern and a list"));
  EXPECT_THAT(refusal("[[press]]\nvertex = 1\n"), HasSubstr("it names no record"));
  EXPECT_THAT(refusal("[[press]]\nfile = \"a.csv\"\nvertex_from = \"{x}\"\n"),
              HasSubstr("the section is of one file"));
  EXPECT_THAT(refusal("[[press]]\nfiles = \"*.dat\"\nvertex = 1\n"), HasSubstr("no file matches"));
  EXPECT_THAT(refusal("[[press]]\nfile = \"a\"\nlist = \"no.csv\"\n"), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace palpate::app
