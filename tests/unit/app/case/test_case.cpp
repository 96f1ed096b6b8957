// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "app/case/case.hpp"
#include "app/case/material.hpp"
#include "format/error.hpp"
#include "tests/support/source_folder.hpp"

namespace palpate::app {
namespace {

using ::testing::HasSubstr;

const std::string kGood = R"(name = "ball"

[surface]
file = "ball.off"
unit = "mm"
region = "gel"

[[inclusion]]
file = "nodule.off"
unit = "cm"
region = "nodule"

[mesh]
patch_spacing = "8 mm"
element_size = "4 mm"

[[support]]
shape = "plane"
point = ["0 mm", "0 mm", "-15 mm"]
normal = [0, 0, -1]

[[support]]
shape = "sphere"
centre = ["1 mm", "2 cm", "0 m"]
radius = "5 mm"

[[support]]
shape = "surface"
file = "bone.stl"
unit = "mm"
distance = "500 um"

[[support]]
shape = "box"
low = ["-1 mm", "-1 mm", "-1 mm"]
high = ["1 mm", "1 mm", "1 mm"]

[[material]]
region = "gel"
young = "10 kPa"
poisson = 0.49

[[material]]
region = "nodule"
young = "0.1 MPa"
poisson = 0.45

[indentation]
depth = "4 mm"
lateral_depths = ["1 mm", "3.3 mm"]
azimuths = ["0 deg", "33.3 deg"]
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The message of the error that reading `text` must raise.
std::string message_of(const std::string& text) {
  try {
    parse_case(text, "ball.toml");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "accepted:\n" << text;
  return {};
}

std::string message_with(const std::string& from, const std::string& to) {
  return message_of(replaced(kGood, from, to));
}

TEST(Case, ReadsQuantitiesInSiAndFillsDefaults) {
  const Case c = parse_case(kGood, "ball.toml");
  EXPECT_EQ(c.name, "ball");
  EXPECT_EQ(c.surface.unit, "mm");
  ASSERT_EQ(c.inclusions.size(), 1U);
  EXPECT_DOUBLE_EQ(c.mesh.patch_spacing, 0.008);
  ASSERT_EQ(c.supports.size(), 4U);
  EXPECT_DOUBLE_EQ(c.supports[2].distance, 0.0005);
  EXPECT_DOUBLE_EQ(c.supports[0].point[2], -0.015);
  EXPECT_DOUBLE_EQ(c.supports[1].centre[1], 0.02);
  EXPECT_DOUBLE_EQ(law_of(c.materials[1]).at("young"), 1e5);
  EXPECT_DOUBLE_EQ(c.indentation.lateral_depths[1], 0.0033);
  EXPECT_EQ(c.indentation.increments, IndentationSection{}.increments);
  EXPECT_EQ(c.fit, FitSection{});
}

TEST(Case, ResolvedCaseReadsBackEqual) {
  const Case c = parse_case(kGood, "ball.toml");
  const std::string resolved = resolved_toml(c);
  EXPECT_EQ(parse_case(resolved, "resolved"), c) << resolved;
  EXPECT_THAT(resolved, HasSubstr("max_knots = 12"));  // a default, spelled out
}

TEST(Case, ResolvedCaseKeepsOddNumbersAndTexts) {
  Case c = parse_case(kGood, "ball.toml");
  c.surface.file = "a \"quoted\"\\ name\twith\x01.off";
  c.mesh.patch_spacing = 0.1 / 3;
  c.materials[0].constant("poisson") = 1.0 / 3;
  c.indentation.azimuths = {1.0 / 7, -2.0};
  c.supports[0].normal = {1.0 / 3, 0, -1e-20};
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c) << resolved_toml(c);
}

std::string with_sampling(const std::string& keys) {
  return replaced(kGood, "[indentation]", "[sampling]\n" + keys + "\n[indentation]");
}

TEST(Case, KeysOfAdaptiveSamplingBelongToIt) {
  EXPECT_EQ(parse_case(kGood, "ball.toml").sampling.method, "spacing");
  const Case c = parse_case(
      with_sampling("method = \"adaptive\"\nstart_spacing = \"2 cm\"\ntolerance = 0.08"), "a");
  EXPECT_DOUBLE_EQ(c.sampling.start_spacing, 0.02);
  EXPECT_DOUBLE_EQ(c.sampling.tolerance, 0.08);
  EXPECT_EQ(c.sampling.hold_out, SamplingSection{}.hold_out);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  EXPECT_ANY_THROW(parse_case(with_sampling("tolerance = 0.08"), "a"));
  EXPECT_ANY_THROW(parse_case(with_sampling("method = \"adaptive\"\ntolerance = 5"), "a"));
  EXPECT_ANY_THROW(parse_case(with_sampling("method = \"adaptive\"\nhold_out = 3"), "a"));
}

TEST(Case, ReadsASupportByTheNameOfFaces) {
  const std::string text =
      replaced(kGood, "[[support]]\nshape = \"sphere\"",
               "[[support]]\nshape = \"label\"\nlabel = \"bone side\"\n\n[[support]]\nshape = "
               "\"sphere\"");
  const Case c = parse_case(text, "ball.toml");
  ASSERT_EQ(c.supports.size(), 5U);
  EXPECT_EQ(c.supports[1].label, "bone side");
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  EXPECT_THAT(message_of(replaced(text, "label = \"bone side\"\n", "")), HasSubstr("label"));
}

TEST(Case, ReadsSpringsAndGravity) {
  const Case held = parse_case(kGood, "ball.toml");
  EXPECT_EQ(held.supports[0].normal_stiffness, 0);
  EXPECT_EQ(held.gravity.acceleration, (Vec3{0, 0, 0}));
  const std::string text =
      replaced(kGood, "normal = [0, 0, -1]",
               "normal = [0, 0, -1]\nnormal_stiffness = \"20 kPa/mm\"\n"
               "tangential_stiffness = \"3e5 N/m^3\"") +
      "\n[gravity]\nacceleration = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]\n"
      "density = \"1.05 g/cm^3\"\n";
  const Case c = parse_case(text, "ball.toml");
  EXPECT_DOUBLE_EQ(c.supports[0].normal_stiffness, 2e7);
  EXPECT_DOUBLE_EQ(c.supports[0].tangential_stiffness, 3e5);
  EXPECT_DOUBLE_EQ(c.gravity.acceleration[2], -9.81);
  EXPECT_DOUBLE_EQ(c.gravity.density, 1050);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  EXPECT_THAT(message_of(replaced(text, "20 kPa/mm", "-1 N/m^3")),
              HasSubstr("support[0].normal_stiffness"));
  EXPECT_THAT(message_of(replaced(text, "20 kPa/mm", "20 kPa")), HasSubstr("kPa/mm, N/mm^3"));
  EXPECT_THAT(message_of(replaced(text, "1.05 g/cm^3", "0 kg/m^3")), HasSubstr("gravity.density"));
}

std::string with_tool(const std::string& tool) {
  return replaced(kGood, "[indentation]", "[tool]\n" + tool + "\n[indentation]");
}

TEST(Case, ToolsHaveTheSizesOfTheirShape) {
  const Case disc = parse_case(
      with_tool(
          "shape = \"disc\"\nradius = \"3 mm\"\nedge_radius = \"500 um\"\nfriction = \"no-slip\""),
      "ball.toml");
  EXPECT_DOUBLE_EQ(disc.tool.edge_radius, 0.0005);
  EXPECT_EQ(disc.tool.friction, "no-slip");
  const Case rod = parse_case(
      with_tool("shape = \"cylinder\"\nlength = \"12 mm\"\nazimuth = \"90 deg\""), "ball.toml");
  EXPECT_DOUBLE_EQ(rod.tool.length, 0.012);
  EXPECT_NEAR(rod.tool.azimuth, 1.5707963267948966, 1e-15);
  for (const Case& c : {disc, rod}) EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
}

TEST(Case, RejectsToolsOfImpossibleSize) {
  EXPECT_THAT(message_of(with_tool("shape = \"disc\"\nradius = \"3 mm\"\nedge_radius = \"4 mm\"")),
              HasSubstr("tool.edge_radius = 4 mm is larger than tool.radius = 3 mm"));
  EXPECT_THAT(message_of(with_tool("shape = \"cylinder\"")), HasSubstr("length"));
  EXPECT_THAT(message_of(with_tool("shape = \"sphere\"\nlength = \"3 mm\"")), HasSubstr("length"));
  EXPECT_THAT(message_of(with_tool("shape = \"cone\"")), HasSubstr("sphere, disc, cylinder"));
  EXPECT_THAT(message_of(with_tool("radius = \"-1 mm\"")), HasSubstr("radius"));
}

TEST(Case, LateralPathsStartAtThreeDepthsUnlessTheCaseSaysOtherwise) {
  const Case c =
      parse_case(replaced(kGood, "lateral_depths = [\"1 mm\", \"3.3 mm\"]\n", ""), "b.toml");
  ASSERT_EQ(c.indentation.lateral_depths.size(), 3U);
  EXPECT_DOUBLE_EQ(c.indentation.lateral_depths[0], 0.004 / 3);
  EXPECT_DOUBLE_EQ(c.indentation.lateral_depths[2], 0.004);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
}

TEST(Case, SectionsOfAStageAreIndependentOfTheOthers) {
  const Case c = parse_case(kGood, "ball.toml");
  Case other = c;
  other.fit.max_knots = 20;
  EXPECT_EQ(resolved_sections(c, {"mesh", "support"}),
            resolved_sections(other, {"mesh", "support"}));
  EXPECT_NE(resolved_sections(c, {"fit"}), resolved_sections(other, {"fit"}));
  EXPECT_THAT(resolved_sections(c, {"fit"}), Not(HasSubstr("ball")));
  EXPECT_THAT(resolved_sections(c, {""}), HasSubstr("ball"));
}

TEST(Case, RejectsBareNumberForADimensionalKey) {
  const std::string message = message_with("\"8 mm\"", "8");
  EXPECT_THAT(message, HasSubstr("ball.toml:14: "));
  EXPECT_THAT(message, HasSubstr("mesh.patch_spacing"));
  EXPECT_THAT(message, HasSubstr("found 8"));
  EXPECT_THAT(message, HasSubstr("patch_spacing = \"10 mm\""));
}

TEST(Case, RejectsWrongOrMissingUnit) {
  EXPECT_THAT(message_with("\"8 mm\"", "\"8 kPa\""), HasSubstr("found '8 kPa'"));
  EXPECT_THAT(message_with("\"8 mm\"", "'8'"), HasSubstr("mesh.patch_spacing"));
  EXPECT_THAT(message_with("\"10 kPa\"", "\"10 mm\""), HasSubstr("units: kPa, MPa, Pa"));
  EXPECT_THAT(message_with("\"-15 mm\"", "\"-15\""), HasSubstr("support[0].point"));
  EXPECT_THAT(message_with("\"33.3 deg\"", "33.3"), HasSubstr("indentation.azimuths"));
}

TEST(Case, RejectsUnitWhereANumberIsBare) {
  EXPECT_THAT(message_with("poisson = 0.49", "poisson = \"0.49\""),
              HasSubstr("material[0].poisson"));
}

TEST(Case, NamesTheNearestKnownKey) {
  const std::string message =
      message_with("young = \"10 kPa\"", "yuong = \"10 kPa\"\nyoung = \"1 Pa\"");
  EXPECT_THAT(message, HasSubstr("unknown key 'yuong' in [[material]]"));
  EXPECT_THAT(message, HasSubstr("'young'"));
  EXPECT_THAT(message, HasSubstr("ball.toml:40: "));
  EXPECT_THAT(message_with("[mesh]", "[mehs]"), HasSubstr("nearest known key is 'mesh'"));
}

TEST(Case, RejectsAKeyOfAnotherShape) {
  EXPECT_THAT(message_with("normal = [0, 0, -1]", "normal = [0, 0, -1]\nradius = \"5 mm\""),
              HasSubstr("unknown key 'radius'"));
}

TEST(Case, RejectsConstantsThatAreNoNumbers) {
  const std::string message = message_with("poisson = 0.49", "poisson = nan");
  EXPECT_THAT(message, HasSubstr("material[0].poisson = nan is out of range"));
  EXPECT_THAT(message, HasSubstr("0 .. 0.5, upper end excluded"));
  EXPECT_THAT(message_with("poisson = 0.49", "poisson = inf"), HasSubstr("= inf is out of range"));
  EXPECT_THAT(message_with("\"10 kPa\"", "\"nan kPa\""), HasSubstr("material[0].young = nan kPa"));
  EXPECT_THAT(message_with("\"10 kPa\"", "\"inf kPa\""), HasSubstr("> 0 kPa"));
  EXPECT_THAT(message_with("\"33.3 deg\"", "\"nan deg\""), HasSubstr("out of range"));
  EXPECT_THAT(message_with("[0, 0, -1]", "[0, 0, nan]"), HasSubstr("support[0].normal"));
}

TEST(Case, RejectsConstantsOutOfRange) {
  EXPECT_THAT(message_with("\"10 kPa\"", "\"-10 kPa\""), HasSubstr("material[0].young = -10 kPa"));
  EXPECT_THAT(message_with("poisson = 0.49", "poisson = 0.5"), HasSubstr("out of range"));
  EXPECT_THAT(message_with("poisson = 0.49", "poisson = -0.1"), HasSubstr("out of range"));
  EXPECT_THAT(message_with("\"4 mm\"\n\n[[support]]", "\"0 mm\"\n\n[[support]]"),
              HasSubstr("mesh.element_size = 0 mm"));
  EXPECT_THAT(message_with("[0, 0, -1]", "[0, 0, 0]"), HasSubstr("not zero"));
}

/// The good case with the material of its first region replaced.
std::string with_material(const std::string& keys) {
  return replaced(kGood, "young = \"10 kPa\"\npoisson = 0.49\n", keys);
}

TEST(Case, ReadsEveryLawByItsConstants) {
  const Case c = parse_case(
      with_material("law = \"ogden-2\"\nmu_1 = \"2 kPa\"\nalpha_1 = 1.3\nmu_2 = \"-100 Pa\"\n"
                    "alpha_2 = -6\npoisson = 0.48\n"),
      "ball.toml");
  const fem::LawConstants law = law_of(c.materials[0]);
  EXPECT_EQ(law.law, "ogden-2");
  EXPECT_DOUBLE_EQ(law.at("mu_2"), -100);
  EXPECT_DOUBLE_EQ(law.at("alpha_2"), -6);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c) << resolved_toml(c);
  EXPECT_EQ(law_of(c.materials[1]).law, "neo-hookean");
}

TEST(Case, ReadsFieldsOfFibres) {
  const std::string hgo =
      "law = \"holzapfel-gasser-ogden\"\nc = \"3 kPa\"\nk1 = \"2.4 kPa\"\nk2 = 0.84\nkappa = 0\n"
      "poisson = 0.49\nfibre_families = 2\nfibre_angle = \"29 deg\"\n";
  const Case c =
      parse_case(with_material(hgo + "fibre_field = \"cylindrical\"\nfibre_axis = [0, 0, 1]\n"
                                     "fibre_axis_point = [\"5 mm\", \"0 mm\", \"0 mm\"]\n"),
                 "ball.toml");
  const fem::FibreField fibres = law_of(c.materials[0]).fibres;
  EXPECT_EQ(fibres.kind, fem::FibreField::Kind::Cylindrical);
  EXPECT_DOUBLE_EQ(fibres.origin[0], 0.005);
  EXPECT_EQ(fibres.families, 2);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c) << resolved_toml(c);
  EXPECT_THAT(message_of(with_material(hgo)), HasSubstr("material[0].fibre_direction"));
  EXPECT_THAT(message_of(with_material(hgo + "fibre_direction = [1, 0, 0]\n"
                                             "fibre_plane = [2, 0, 0]\n")),
              HasSubstr("parallel"));
}

TEST(Case, ReadsFieldsOfFibresThatDependOnTheBody) {
  const std::string hgo =
      "law = \"holzapfel-gasser-ogden\"\nc = \"3 kPa\"\nk1 = \"2.4 kPa\"\nk2 = 0.84\nkappa = 0\n"
      "poisson = 0.49\nfibre_plane = [0, 0, 1]\n";
  const std::string box =
      "fibre_field = \"laplace\"\nfibre_from_low = [\"0 mm\", \"0 mm\", \"0 mm\"]\n"
      "fibre_from_high = [\"1 mm\", \"1 mm\", \"1 mm\"]\nfibre_to_low = [\"3 mm\", \"0 mm\", \"0 "
      "mm\"]\n";
  const std::string end = "fibre_to_high = [\"4 mm\", \"1 mm\", \"1 mm\"]\n";
  const Case between = parse_case(with_material(hgo + box + end), "ball.toml");
  const fem::FibreField fibres = law_of(between.materials[0]).fibres;
  EXPECT_EQ(fibres.kind, fem::FibreField::Kind::Laplace);
  EXPECT_DOUBLE_EQ(fibres.to.low[0], 0.003);
  EXPECT_DOUBLE_EQ(fibres.from.high[1], 0.001);
  EXPECT_EQ(parse_case(resolved_toml(between), "resolved"), between) << resolved_toml(between);
  EXPECT_THAT(message_of(with_material(hgo + box)), HasSubstr("material[0].fibre_to_high"));

  const Case of_file = parse_case(
      with_material(hgo + "fibre_field = \"file\"\nfibre_file = \"f.csv\"\nfibre_unit = \"mm\"\n"),
      "ball.toml");
  EXPECT_EQ(law_of(of_file.materials[0]).fibres.kind, fem::FibreField::Kind::Sampled);
  EXPECT_TRUE(reads_fibre_file(of_file.materials[0]));
  EXPECT_THROW(law_of(of_file.materials[0], "/nonexistent"), Error);
  EXPECT_EQ(parse_case(resolved_toml(of_file), "resolved"), of_file) << resolved_toml(of_file);
}

TEST(Case, RejectsConstantsThatTheLawHasNotOrThatDoNotFit) {
  const std::string mooney = "law = \"mooney-rivlin\"\nC10 = \"1 kPa\"\npoisson = 0.49\n";
  EXPECT_THAT(message_of(with_material(mooney)), HasSubstr("material[0].C01"));
  EXPECT_THAT(message_of(with_material(mooney + "C01 = \"-2 kPa\"\n")),
              HasSubstr("C10 + C01 = -1000"));
  EXPECT_THAT(message_of(with_material(mooney + "C01 = \"1 kPa\"\nyoung = \"1 kPa\"\n")),
              HasSubstr("unknown key 'young'"));
  EXPECT_THAT(message_of(with_material("law = \"demiray-fung\"\nmu = \"1 kPa\"\nb = -1\n"
                                       "poisson = 0.49\n")),
              HasSubstr("material[0].b = -1"));
  EXPECT_THAT(message_of(with_material("law = \"mooney\"\n")),
              HasSubstr("is 'mooney', which is not one of neo-hookean, mooney-rivlin"));
}

TEST(Case, ChecksThatPartsFitTogether) {
  EXPECT_THAT(message_with("\"3.3 mm\"", "\"4.1 mm\""), HasSubstr("4.1 mm, deeper than"));
  EXPECT_THAT(message_with("region = \"nodule\"\nyoung", "region = \"noduel\"\nyoung"),
              HasSubstr("the nearest region is 'nodule'"));
  EXPECT_THAT(message_with("region = \"nodule\"\nyoung", "region = \"gel\"\nyoung"),
              HasSubstr("second material for region 'gel'"));
  EXPECT_THAT(message_with("region = \"nodule\"\n\n", "region = \"gel\"\n\n"),
              HasSubstr("named twice"));
  EXPECT_THAT(message_with("\"1 mm\", \"1 mm\", \"1 mm\"]", "\"1 mm\", \"-2 mm\", \"1 mm\"]"),
              HasSubstr("low.y not below high.y"));
  EXPECT_THAT(message_with("element_size = \"4 mm\"", "element_size = \"9 mm\""),
              HasSubstr("larger than mesh.patch_spacing"));
  EXPECT_THAT(message_with("name = \"ball\"", "name = \"../ball\""), HasSubstr("cannot name"));
}

TEST(Case, RejectsASharpEdgeWithoutFriction) {
  const std::string disc = "shape = \"disc\"\nradius = \"3 mm\"\n";
  EXPECT_THAT(message_of(with_tool(disc)), HasSubstr("sharp edge"));
  EXPECT_EQ(parse_case(with_tool(disc + "friction = \"no-slip\"\n"), "x.toml").tool.edge_radius, 0);
  EXPECT_EQ(parse_case(with_tool(disc + "edge_radius = \"0.03 mm\"\n"), "x.toml").tool.shape,
            "disc");
}

TEST(Case, RejectsWhatIsMissing) {
  EXPECT_THAT(message_with("unit = \"mm\"\n", ""), HasSubstr("key 'surface.unit' is missing"));
  EXPECT_THAT(message_with("poisson = 0.49\n", ""), HasSubstr("material[0].poisson"));
  EXPECT_THAT(message_with("poisson = 0.49\n", "posson = 0.49\n"),
              HasSubstr("unknown key 'posson'"));
  EXPECT_THAT(message_with("shape = \"box\"\n", ""), HasSubstr("support[3].shape"));
  EXPECT_THAT(message_of("name = \"x\"\n"), HasSubstr("key 'surface' is missing"));
}

TEST(Case, NamesItselfAfterItsFileAndItsMaterialAfterTheSurface) {
  const Case c = parse_case(R"([surface]
file = "x.off"
unit = "in"
[[support]]
shape = "plane"
point = ["0 mm", "0 mm", "0 mm"]
normal = [0, 0, -1]
[[material]]
young = "10 kPa"
poisson = 0.45
)",
                            "some/folder/kidney-3.toml");
  EXPECT_EQ(c.name, "kidney-3");
  EXPECT_EQ(c.materials.at(0).region, c.surface.region);
}

TEST(Case, ReportsTheLineOfBadToml) {
  EXPECT_THAT(message_with("[mesh]", "[mesh"), HasSubstr("ball.toml:13: this is not TOML"));
  EXPECT_THAT(message_with("unit = \"cm\"", "unit = \"foot\""), HasSubstr("not one of mm, cm"));
}

TEST(Case, UnreadableFileIsAnError) {
  try {
    read_case("/nonexistent/case.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_EQ(error.where(), "/nonexistent/case.toml");
  }
}

TEST(Case, ShippedCasesAreValid) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_folder() / "data/cases")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const Case c = read_case(entry.path());
    EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  }
  EXPECT_GE(count, 1);
}

/// Set PALPATE_UPDATE_DOCS=1 to rewrite the tables of the page from the parser.
TEST(Case, ReferencePageListsWhatTheReaderAccepts) {
  const std::string path = (test::source_folder() / "docs/cases.md").string();
  std::ostringstream page;
  page << std::ifstream(path).rdbuf();
  const std::string begin = "<!-- keys: begin -->\n";
  const std::string end = "<!-- keys: end -->";
  const std::string text = page.str();
  const auto first = text.find(begin);
  const auto last = text.find(end);
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(last, std::string::npos);
  const std::string expected =
      text.substr(0, first + begin.size()) + case_reference() + text.substr(last);
  if (std::getenv("PALPATE_UPDATE_DOCS") != nullptr) std::ofstream(path) << expected;
  EXPECT_EQ(text, expected) << "run this test once with PALPATE_UPDATE_DOCS=1";
}

}  // namespace
}  // namespace palpate::app
