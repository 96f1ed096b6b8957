// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/case/reader.hpp"
#include "format/body.hpp"
#include "format/error.hpp"
#include "format/flat_library.hpp"
#include "tests/support/sample_artifacts.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/app/case/good_case.hpp"

namespace palpate::app {
namespace {

TEST(CaseReader, RejectsBareNumberForADimensionalKey) {
  const std::string message = message_with("\"8 mm\"", "8");
  EXPECT_THAT(message, HasSubstr("ball.toml:14: "));
  EXPECT_THAT(message, HasSubstr("mesh.patch_spacing"));
  EXPECT_THAT(message, HasSubstr("found 8"));
  EXPECT_THAT(message, HasSubstr("patch_spacing = \"10 mm\""));
}

TEST(CaseReader, RejectsWrongOrMissingUnit) {
  EXPECT_THAT(message_with("\"8 mm\"", "\"8 kPa\""), HasSubstr("found '8 kPa'"));
  EXPECT_THAT(message_with("\"8 mm\"", "'8'"), HasSubstr("mesh.patch_spacing"));
  EXPECT_THAT(message_with("\"10 kPa\"", "\"10 mm\""),
              HasSubstr("units: kPa, MPa, psi, kgf/cm^2, N/mm^2, Pa"));
  EXPECT_THAT(message_with("\"-15 mm\"", "\"-15\""), HasSubstr("support[0].point"));
  EXPECT_THAT(message_with("\"33.3 deg\"", "33.3"), HasSubstr("indentation.azimuths"));
  EXPECT_THAT(message_with("\"33.3 deg\"", "33.3"), HasSubstr("an angle with its unit"));
  EXPECT_THAT(message_with("\"8 mm\"", "8"), HasSubstr("a length with its unit"));
}

TEST(CaseReader, SaysThatAnArtifactIsNoCase) {
  const samples::TemporaryFolder folder;
  write_body(folder / "body.h5", samples::body(1));
  write_flat_library(folder / "library.plib", samples::library(1));
  for (const char* name : {"body.h5", "library.plib"}) {
    try {
      read_toml(folder / name, "the case file");
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("is an artifact of palpate, not the case file")) << name;
    }
  }
}

TEST(CaseReader, RejectsUnitWhereANumberIsBare) {
  EXPECT_THAT(message_with("poisson = 0.49", "poisson = \"0.49\""),
              HasSubstr("material[0].poisson"));
}

TEST(CaseReader, NamesTheNearestKnownKey) {
  const std::string message =
      message_with("young = \"10 kPa\"", "yuong = \"10 kPa\"\nyoung = \"1 Pa\"");
  EXPECT_THAT(message, HasSubstr("unknown key 'yuong' in [[material]]"));
  EXPECT_THAT(message, HasSubstr("'young'"));
  EXPECT_THAT(message, HasSubstr("ball.toml:40: "));
  EXPECT_THAT(message_with("[mesh]", "[mehs]"), HasSubstr("nearest known key is 'mesh'"));
}

TEST(CaseReader, RejectsAKeyOfAnotherShape) {
  EXPECT_THAT(message_with("normal = [0, 0, -1]", "normal = [0, 0, -1]\nradius = \"5 mm\""),
              HasSubstr("unknown key 'radius'"));
}

TEST(CaseReader, RejectsNumbersThatAreNotFinite) {
  const std::string message = message_with("poisson = 0.49", "poisson = nan");
  EXPECT_THAT(message, HasSubstr("material[0].poisson = nan is out of range"));
  EXPECT_THAT(message, HasSubstr("0 .. 0.5, upper end excluded"));
  EXPECT_THAT(message_with("poisson = 0.49", "poisson = inf"), HasSubstr("= inf is out of range"));
  EXPECT_THAT(message_with("\"10 kPa\"", "\"nan kPa\""), HasSubstr("material[0].young = nan kPa"));
  EXPECT_THAT(message_with("\"10 kPa\"", "\"inf kPa\""), HasSubstr("> 0 kPa"));
  EXPECT_THAT(message_with("\"33.3 deg\"", "\"nan deg\""), HasSubstr("out of range"));
  EXPECT_THAT(message_with("[0, 0, -1]", "[0, 0, nan]"), HasSubstr("support[0].normal"));
}

TEST(CaseReader, ReadsAFlagOrACount) {
  const auto refinements = [](const std::string& value) {
    return parse_case(kGood + "\n[solver]\nrefine_under_tool = " + value + "\n", "ball.toml")
        .campaign.indentation.refine_under_tool;
  };
  EXPECT_EQ(parse_case(kGood, "ball.toml").campaign.indentation.refine_under_tool, 0);
  EXPECT_EQ(refinements("false"), 0);
  EXPECT_EQ(refinements("true"), 1);
  EXPECT_EQ(refinements("0"), 0);
  EXPECT_EQ(refinements("1"), 1);
  EXPECT_EQ(refinements("3"), 3);
  EXPECT_EQ(refinements("\"contact\""), fem::IndentationSettings::kByContact);
  const auto message = [&](const std::string& value) -> std::string {
    try {
      refinements(value);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("7"), HasSubstr("solver.refine_under_tool = 7 is out of range"));
  EXPECT_THAT(message("-1"), HasSubstr("out of range"));
  EXPECT_THAT(message("1.5"), HasSubstr("true, false, 'contact' or an integer"));
  EXPECT_THAT(message("\"twice\""), HasSubstr("true, false, 'contact' or an integer"));
}

TEST(CaseReader, RejectsValuesOutOfRange) {
  EXPECT_THAT(message_with("\"10 kPa\"", "\"-10 kPa\""), HasSubstr("material[0].young = -10 kPa"));
  EXPECT_THAT(message_with("poisson = 0.49", "poisson = 0.5"), HasSubstr("out of range"));
  EXPECT_THAT(message_with("poisson = 0.49", "poisson = -0.1"), HasSubstr("out of range"));
  EXPECT_THAT(message_with("\"4 mm\"\n\n[[support]]", "\"0 mm\"\n\n[[support]]"),
              HasSubstr("mesh.element_size = 0 mm"));
  EXPECT_THAT(message_with("[0, 0, -1]", "[0, 0, 0]"), HasSubstr("not zero"));
}

TEST(CaseReader, RejectsMissingKeys) {
  EXPECT_THAT(message_with("unit = \"mm\"\n", ""), HasSubstr("key 'surface.unit' is missing"));
  EXPECT_THAT(message_with("poisson = 0.49\n", ""), HasSubstr("material[0].poisson"));
  EXPECT_THAT(message_with("poisson = 0.49\n", "posson = 0.49\n"),
              HasSubstr("unknown key 'posson'"));
  EXPECT_THAT(message_with("shape = \"box\"\n", ""), HasSubstr("support[3].shape"));
  EXPECT_THAT(message_of("name = \"x\"\n"), HasSubstr("key 'support' is missing"));
}

TEST(CaseReader, SaysOfAMissingKeyWhatItMayBe) {
  EXPECT_THAT(message_with("shape = \"box\"\n", ""), HasSubstr("one of plane, box, sphere"));
}

TEST(CaseReader, NamesTheLineOfInvalidToml) {
  EXPECT_THAT(message_with("[mesh]", "[mesh"), HasSubstr("ball.toml:13: invalid TOML"));
  EXPECT_THAT(message_with("unit = \"cm\"", "unit = \"foot\""), HasSubstr("not one of mm, cm"));
}

TEST(CaseReader, RejectsAnUnreadableFile) {
  try {
    read_case("/nonexistent/case.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_EQ(error.where(), "/nonexistent/case.toml");
  }
}

}  // namespace
}  // namespace palpate::app
