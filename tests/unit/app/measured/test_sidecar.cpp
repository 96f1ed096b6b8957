// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/sidecar.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "format/error.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

const std::string kHead =
    "name = \"a\"\nspecimen = \"b\"\nsource = \"c\"\nlicence = \"d\"\n"
    "[tool]\nradius = \"6 mm\"\nfriction = \"no-slip\"\n";
const std::string kColumns = "[columns]\ndisplacement = \"x\"\nforce = \"f\"\n";
const std::string kPress = "[[press]]\nfile = \"a.csv\"\nvertex = 3\n";

std::string refusal(const std::string& text, const std::string& name = "a.toml") {
  const samples::TemporaryFolder folder;
  std::ofstream(folder / name) << text;
  try {
    read_sidecar(folder / name);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "accepted";
}

TEST(Sidecar, OfTheShippedPadIsReadInSi) {
  const auto folder = test::source_folder() / "data/measured/pad";
  const Sidecar presses = read_sidecar(folder / "presses.toml");
  EXPECT_EQ(presses.tool.radius, 0.006);
  EXPECT_EQ(presses.machine.compliance, 0.05e-3);
  EXPECT_EQ(presses.presses.size(), 18U);
  EXPECT_EQ(presses.presses[0].vertex, -1);
  EXPECT_EQ(presses.presses[0].site[2], 0.020);
  EXPECT_EQ(presses.path.samples, 12);
  EXPECT_FALSE(read_sidecar(folder / "robot.toml").robot_logs.empty());
}

/// A tool of tens of micrometres on a cell: every unit that records may have serves the sidecar.
TEST(Sidecar, TakesQuantitiesInSmallUnits) {
  const samples::TemporaryFolder folder;
  std::ofstream(folder / "a.toml")
      << "name = \"a\"\nspecimen = \"b\"\nsource = \"c\"\nlicence = \"d\"\n"
         "[tool]\nradius = \"25000 nm\"\nfriction = \"frictionless\"\n"
         "[machine]\ncompliance = \"2 um/mN\"\n"
      << kColumns << "[contact]\nmethod = \"threshold\"\nthreshold = \"0.005 uN\"\n"
      << kPress;
  const Sidecar sidecar = read_sidecar(folder / "a.toml");
  EXPECT_DOUBLE_EQ(sidecar.tool.radius, 25e-6);
  EXPECT_DOUBLE_EQ(sidecar.machine.compliance, 2e-3);
  EXPECT_DOUBLE_EQ(sidecar.contact.threshold, 5e-9);
}

TEST(Sidecar, RefusesWhatItCannotUse) {
  EXPECT_EQ(refusal(kHead + kColumns + kPress), "accepted");
  EXPECT_THAT(refusal(kHead + kColumns), HasSubstr("it names no record"));
  EXPECT_THAT(refusal("name = \"a\"\nspecimen = \"b\"\nsource = \"c\"\nlicence = \"d\"\n"
                      "[tool]\nradius = \"6 mm\"\n" +
                      kColumns + kPress),
              HasSubstr("'tool.friction' is missing; add it: friction of the press; "
                        "one of frictionless, no-slip"));
  EXPECT_THAT(refusal("name = \"a\"\nspecimen = \"b\"\nsource = \"c\"\nlicence = \"d\"\n" +
                      kColumns + kPress),
              HasSubstr("key 'tool' is missing; add it: [tool], shape and size"));
  EXPECT_THAT(
      refusal(kHead + kPress),
      HasSubstr("key 'columns' is missing; add it: [columns], with the names of the columns"));
  EXPECT_THAT(refusal(kHead + "[columns]\nforce = \"f\"\n" + kPress),
              HasSubstr("key 'columns.displacement' is missing"));
  EXPECT_THAT(refusal(kHead + kColumns + "[[press]]\nfile = \"a.csv\"\n"),
              HasSubstr("neither vertex nor site is given"));
  EXPECT_THAT(refusal(kHead + kColumns + kPress + "site = [\"1 mm\", \"1 mm\", \"1 mm\"]\n"),
              HasSubstr("both vertex and site are given"));
  EXPECT_THAT(refusal(kHead + kColumns + "[contact]\nmethod = \"threshold\"\n" + kPress),
              HasSubstr("key 'contact.threshold' is missing"));
  EXPECT_THAT(refusal(kHead + kColumns + "[contact]\nmethod = \"given\"\n" + kPress),
              HasSubstr("key 'contact.position' is missing"));
  EXPECT_EQ(refusal(kHead + kColumns + "[contact]\nmethod = \"given\"\n" + kPress +
                    "contact = \"-0.2 mm\"\n"),
            "accepted");
  EXPECT_THAT(refusal(kHead + kColumns + kPress + "contact = \"0 mm\"\n"),
              HasSubstr("say contact.method = \"given\""));
  EXPECT_THAT(refusal(kHead + kColumns + "[contact]\nposition = \"0 mm\"\n" + kPress),
              HasSubstr("say contact.method = \"given\""));
  EXPECT_THAT(refusal(kHead + kColumns + "[[robot]]\nfile = \"a.csv\"\n"),
              HasSubstr("key 'columns.x' is missing"));
  EXPECT_THAT(refusal("0,1\n", "a.csv"), HasSubstr("this is a record, not its sidecar"));
}

/// Between plates there is no curve of a tool, and a record over time needs its time.
TEST(Sidecar, TakesRecordsOverTime) {
  const std::string plates =
      "name = \"a\"\nspecimen = \"b\"\nsource = \"c\"\nlicence = \"d\"\n[tool]\nshape = "
      "\"plates\"\n";
  const std::string timed = "[columns]\ntime = \"t\"\ndisplacement = \"x\"\nforce = \"f\"\n";
  const std::string history = "[[history]]\nfile = \"a.csv\"\n";
  EXPECT_EQ(refusal(plates + timed + history), "accepted");
  EXPECT_EQ(refusal(kHead + timed + history), "accepted");
  EXPECT_THAT(refusal(kHead + kColumns + history), HasSubstr("key 'columns.time' is missing"));
  EXPECT_THAT(refusal(plates + timed + kPress), HasSubstr("the tool is plates"));
  const std::string pulled = timed + "load = \"tension\"\n";
  EXPECT_EQ(refusal(plates + pulled + history), "accepted");
  EXPECT_THAT(refusal(kHead + pulled + history), HasSubstr("a pull is no press"));
  EXPECT_THAT(refusal(kHead + timed + history + "contact = \"1 mm\"\n"),
              HasSubstr("contact.method says otherwise"));
  EXPECT_THAT(refusal(kHead + timed + history + "held = \"both\"\n"), HasSubstr("both"));
}

const std::string kTwoTools =
    "name = \"a\"\nspecimen = \"b\"\nsource = \"c\"\nlicence = \"d\"\n"
    "[[tool]]\nname = \"small\"\nradius = \"2 mm\"\nfriction = \"no-slip\"\n"
    "[[tool]]\nname = \"large\"\nradius = \"6 mm\"\nfriction = \"frictionless\"\n" +
    kColumns;

std::string press_of(const std::string& tool, int vertex) {
  return kPress.substr(0, kPress.find("vertex")) + "vertex = " + std::to_string(vertex) +
         "\ntool = \"" + tool + "\"\n";
}

TEST(Sidecar, OfSeveralToolsIsReadOneToolAtATime) {
  const samples::TemporaryFolder folder;
  const auto file = folder / "a.toml";
  std::ofstream(file) << kTwoTools << press_of("large", 1) << press_of("small", 2)
                      << press_of("large", 3);
  EXPECT_EQ(tools_of_sidecar(file), (std::vector<std::string>{"small", "large"}));
  const Sidecar small = read_sidecar(file, "small"), large = read_sidecar(file, "large");
  EXPECT_EQ(small.tool.radius, 0.002);
  ASSERT_EQ(small.presses.size(), 1U);
  EXPECT_EQ(small.presses[0].vertex, 2);
  EXPECT_EQ(large.tool.friction, "frictionless");
  ASSERT_EQ(large.presses.size(), 2U);
  EXPECT_EQ(large.presses[1].vertex, 3);
}

TEST(Sidecar, TakesTheToolsOfRecordsFromTheirNames) {
  const samples::TemporaryFolder folder;
  for (const char* name : {"small-1.csv", "large-1.csv", "large-2.csv"})
    std::ofstream(folder / name) << "x\n";
  const auto file = folder / "a.toml";
  std::ofstream(file) << kTwoTools
                      << "[[press]]\nfiles = \"{tool}-{v}.csv\"\nvertex_from = \"{v}\"\n"
                         "tool_from = \"{tool}\"\n";
  EXPECT_EQ(read_sidecar(file, "small").presses.size(), 1U);
  EXPECT_EQ(read_sidecar(file, "large").presses.size(), 2U);
}

/// Curves of two tools are never mixed: nothing is read that leaves the tool open.
TEST(Sidecar, RefusesRecordsWhoseToolIsNotClear) {
  const std::string small = press_of("small", 1), large = press_of("large", 1);
  EXPECT_THAT(refusal(kTwoTools + small + large), HasSubstr("several tools: 'small', 'large'"));
  EXPECT_THAT(refusal(kTwoTools + small + kPress),
              HasSubstr("it does not say which of several tools pressed"));
  EXPECT_THAT(refusal(kTwoTools + small + press_of("huge", 1)),
              HasSubstr("no [[tool]] has the name 'huge'"));
  EXPECT_THAT(refusal(kTwoTools + small), HasSubstr("no record is of the tool 'large'"));
  EXPECT_THAT(refusal(kHead + kColumns + small), HasSubstr("no [[tool]] has the name 'small'"));
  std::string twice = kTwoTools;
  twice.replace(twice.find("\"large\""), 7, "\"small\"");
  EXPECT_THAT(refusal(twice + small), HasSubstr("two tools have the name 'small'"));
  std::string nameless = kTwoTools;
  nameless.replace(nameless.find("name = \"large\"\n"), 15, "");
  EXPECT_THAT(refusal(nameless + small), HasSubstr("key 'tool.name' is missing"));
  std::string path = kTwoTools;
  path.replace(path.find("\"large\""), 7, "\"../up\"");
  EXPECT_THAT(refusal(path + small), HasSubstr("import makes a folder of it"));
}

}  // namespace
}  // namespace palpate::app
