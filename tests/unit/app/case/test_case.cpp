// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <variant>

#include "tests/support/source_folder.hpp"
#include "tests/unit/app/case/good_case.hpp"

namespace palpate::app {
namespace {

TEST(Case, ReadsQuantitiesInSiAndFillsDefaults) {
  const Case c = parse_case(kGood, "ball.toml");
  EXPECT_EQ(c.name, "ball");
  EXPECT_EQ(c.mesh.surface.unit, 1e-3);
  ASSERT_EQ(c.mesh.inclusions.size(), 1U);
  EXPECT_DOUBLE_EQ(c.mesh.patch_spacing, 0.008);
  ASSERT_EQ(c.supports.size(), 4U);
  EXPECT_DOUBLE_EQ(std::get<mesher::SurfaceSupport>(c.supports[2].where.shape).distance, 0.0005);
  EXPECT_DOUBLE_EQ(std::get<mesher::PlaneSupport>(c.supports[0].where.shape).point[2], -0.015);
  EXPECT_DOUBLE_EQ(std::get<mesher::SphereSupport>(c.supports[1].where.shape).centre[1], 0.02);
  EXPECT_DOUBLE_EQ(c.materials[1].law.at("young"), 1e5);
  EXPECT_DOUBLE_EQ(c.campaign.indentation.lateral_depths[1], 0.0033);
  EXPECT_EQ(c.campaign.indentation.increments, fem::IndentationSettings{}.increments);
  Case without_fit = c;
  without_fit.fit = fit_of_case();
  EXPECT_EQ(c, without_fit);
}

std::string with_sampling(const std::string& keys) {
  return replaced(kGood, "[indentation]", "[sampling]\n" + keys + "\n[indentation]");
}

TEST(Case, KeysOfAdaptiveSamplingBelongToIt) {
  EXPECT_EQ(parse_case(kGood, "ball.toml").sampling.method, SamplingMethod::Vertices);
  const Case c = parse_case(
      with_sampling("method = \"adaptive\"\ninitial_spacing = \"2 cm\"\ntolerance = 0.08"), "a");
  EXPECT_DOUBLE_EQ(c.sampling.initial_spacing, 0.02);
  EXPECT_DOUBLE_EQ(c.sampling.tolerance, 0.08);
  EXPECT_EQ(c.sampling.hold_out_points, SamplingSection{}.hold_out_points);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  EXPECT_ANY_THROW(parse_case(with_sampling("tolerance = 0.08"), "a"));
  EXPECT_ANY_THROW(parse_case(with_sampling("method = \"adaptive\"\ntolerance = 5"), "a"));
  EXPECT_ANY_THROW(parse_case(with_sampling("method = \"adaptive\"\nhold_out_points = 3"), "a"));
}

TEST(Case, ReadsASupportByTheNameOfFaces) {
  const std::string text =
      replaced(kGood, "[[support]]\nshape = \"sphere\"",
               "[[support]]\nshape = \"label\"\nlabel = \"bone side\"\n\n[[support]]\nshape = "
               "\"sphere\"");
  const Case c = parse_case(text, "ball.toml");
  ASSERT_EQ(c.supports.size(), 5U);
  EXPECT_EQ(std::get<mesher::LabelSupport>(c.supports[1].where.shape).label, "bone side");
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  EXPECT_THAT(message_of(replaced(text, "label = \"bone side\"\n", "")), HasSubstr("label"));
}

std::string with_volume_mesh() {
  const std::string good(kGood);
  const std::size_t begin = good.find("[surface]"), inclusion = good.find("[[inclusion]]");
  const std::size_t end = good.find("\n[", inclusion + 2);
  return good.substr(0, begin) +
         "[volume_mesh]\nfile = \"organ.msh\"\nunit = \"mm\"\n"
         "[[mesh_region]]\ngroup = \"region=3\"\nregion = \"nodule\"\n" +
         good.substr(end);
}

TEST(Case, ReadsAVolumeMeshInThePlaceOfASurface) {
  const Case c = parse_case(with_volume_mesh(), "ball.toml");
  EXPECT_EQ(c.mesh.source(), "organ.msh");
  EXPECT_EQ(c.mesh.volume_mesh.unit, 1e-3);
  ASSERT_EQ(c.mesh.volume_mesh.regions.size(), 1U);
  EXPECT_EQ(c.mesh.volume_mesh.regions[0].group, "region=3");
  EXPECT_EQ(resolved_toml(c).find("[surface]"), std::string::npos);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
}

TEST(Case, ReadsAnImageAndItsLabels) {
  const std::string labels =
      "[[image_label]]\nvalue = 3\nregion = \"gel\"\n"
      "[[image_label]]\nvalue = 8\nregion = \"nodule\"\n";
  const auto with_image = [&](const std::string& more) {
    return replaced(replaced(with_volume_mesh(),
                             "[[mesh_region]]\ngroup = \"region=3\"\nregion = \"nodule\"\n", more),
                    "[volume_mesh]\nfile = \"organ.msh\"\nunit = \"mm\"\n",
                    "[image]\nfile = \"organ.nii.gz\"\n");
  };
  const Case c = parse_case(with_image(labels), "ball.toml");
  EXPECT_EQ(c.mesh.source(), "organ.nii.gz");
  EXPECT_EQ(c.mesh.image.unit, 0);
  ASSERT_EQ(c.mesh.image.labels.size(), 2U);
  EXPECT_EQ(c.mesh.image.labels[1].value, 8);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  EXPECT_THAT(message_of(with_image("")), HasSubstr("[image] without [[image_label]]"));
  EXPECT_THAT(message_of(with_image(labels + "[[image_label]]\nvalue = 3\nregion = \"a\"\n")),
              HasSubstr("the label 3 for the second time"));
  EXPECT_THAT(message_of(with_image("[[image_label]]\nvalue = 8\nregion = \"nodule\"\n")),
              HasSubstr("which no surface bounds"));
}

TEST(Case, TakesExactlyOneSourceOfTheBody) {
  const std::string mesh = "[volume_mesh]\nfile = \"a.msh\"\nunit = \"mm\"\n";
  EXPECT_THAT(message_of(std::string(kGood) + mesh), HasSubstr("both [surface] and [volume_mesh]"));
  EXPECT_THAT(message_of(std::string(kGood) + "[[mesh_region]]\ngroup = \"a\"\nregion = \"b\"\n"),
              HasSubstr("[[mesh_region]] with [surface]"));
  EXPECT_THAT(message_of(replaced(with_volume_mesh(),
                                  "[volume_mesh]\nfile = \"organ.msh\"\nunit = \"mm\"\n", "")),
              HasSubstr("none of [surface], [volume_mesh], [image] and [measured]"));
  EXPECT_THAT(message_of(with_volume_mesh() +
                         "[[inclusion]]\nfile = \"a\"\nunit = \"m\"\nregion = \"b\"\n"),
              HasSubstr("[[inclusion]] with [volume_mesh]"));
}

TEST(Case, ReadsPressZonesAndInvertedSelectors) {
  const std::string text = std::string(kGood) +
                           "[[press]]\nshape = \"label\"\nlabel = \"top\"\n"
                           "[[press]]\nshape = \"sphere\"\ninvert = true\n"
                           "centre = [\"1 mm\", \"2 mm\", \"3 mm\"]\nradius = \"4 mm\"\n";
  const Case c = parse_case(text, "ball.toml");
  ASSERT_EQ(c.mesh.press.size(), 2U);
  EXPECT_FALSE(c.mesh.press[0].inverted);
  EXPECT_TRUE(c.mesh.press[1].inverted);
  EXPECT_DOUBLE_EQ(std::get<mesher::SphereSupport>(c.mesh.press[1].shape).radius, 0.004);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  EXPECT_THAT(message_of(std::string(kGood) +
                         "[[press]]\nshape = \"box\"\nlow = [\"0 m\", \"0 m\", \"0 m\"]\n"
                         "high = [\"1 m\", \"0 m\", \"1 m\"]\n"),
              HasSubstr("low.y not below high.y"));
}

TEST(Case, ReadsSpringsAndGravity) {
  const Case fixed = parse_case(kGood, "ball.toml");
  EXPECT_EQ(fixed.supports[0].normal_stiffness, 0);
  EXPECT_EQ(fixed.campaign.gravity.acceleration, (Vec3{0, 0, 0}));
  const std::string text =
      replaced(kGood, "normal = [0, 0, -1]",
               "normal = [0, 0, -1]\nnormal_stiffness = \"20 kPa/mm\"\n"
               "tangential_stiffness = \"3e5 N/m^3\"") +
      "\n[gravity]\nacceleration = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]\n"
      "density = \"1.05 g/cm^3\"\n";
  const Case c = parse_case(text, "ball.toml");
  EXPECT_DOUBLE_EQ(c.supports[0].normal_stiffness, 2e7);
  EXPECT_DOUBLE_EQ(c.supports[0].tangential_stiffness, 3e5);
  EXPECT_DOUBLE_EQ(c.campaign.gravity.acceleration[2], -9.81);
  EXPECT_DOUBLE_EQ(c.campaign.gravity.density, 1050);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  EXPECT_THAT(message_of(replaced(text, "20 kPa/mm", "-1 N/m^3")),
              HasSubstr("support[0].normal_stiffness"));
  EXPECT_THAT(message_of(replaced(text, "20 kPa/mm", "20 kPa")), HasSubstr("kPa/mm, N/mm^3"));
  EXPECT_THAT(message_of(replaced(text, "1.05 g/cm^3", "0 kg/m^3")), HasSubstr("gravity.density"));
}

TEST(Case, ReadsTheGivenShapeAndDensitiesOfMaterials) {
  EXPECT_EQ(parse_case(kGood, "ball.toml").campaign.gravity.shape, fem::GivenShape::Unloaded);
  const std::string text =
      replaced(kGood, "[[material]]\n", "[[material]]\ndensity = \"0.9 g/cm^3\"\n") +
      "\n[gravity]\nshape = \"loaded\"\n";
  const Case c = parse_case(text, "ball.toml");
  EXPECT_EQ(c.campaign.gravity.shape, fem::GivenShape::Loaded);
  EXPECT_DOUBLE_EQ(c.materials[0].density, 900);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  EXPECT_THAT(message_of(replaced(text, "\"loaded\"", "\"sagged\"")), HasSubstr("gravity.shape"));
  EXPECT_THAT(message_of(replaced(text, "0.9 g/cm^3", "-1 g/cm^3")), HasSubstr("density"));
}

std::string with_tool(const std::string& tool) {
  return replaced(kGood, "[indentation]", "[tool]\n" + tool + "\n[indentation]");
}

TEST(Case, ToolsHaveTheSizesOfTheirShape) {
  const Case disc = parse_case(
      with_tool(
          "shape = \"disc\"\nradius = \"3 mm\"\nedge_radius = \"500 um\"\nfriction = \"no-slip\""),
      "ball.toml");
  EXPECT_DOUBLE_EQ(disc.campaign.indentation.tool.edge_radius, 0.0005);
  EXPECT_EQ(disc.campaign.indentation.friction, fem::ToolFriction::NoSlip);
  const Case rod = parse_case(
      with_tool("shape = \"cylinder\"\nlength = \"12 mm\"\nazimuth = \"90 deg\""), "ball.toml");
  EXPECT_DOUBLE_EQ(rod.campaign.indentation.tool.length, 0.012);
  EXPECT_NEAR(rod.campaign.indentation.tool_azimuth, 1.5707963267948966, 1e-15);
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
  ASSERT_EQ(c.campaign.indentation.lateral_depths.size(), 3U);
  EXPECT_DOUBLE_EQ(c.campaign.indentation.lateral_depths[0], 0.004 / 3);
  EXPECT_DOUBLE_EQ(c.campaign.indentation.lateral_depths[2], 0.004);
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
}

TEST(Case, ChecksThatPartsFitTogether) {
  EXPECT_THAT(message_with("\"3.3 mm\"", "\"4.1 mm\""),
              HasSubstr("4.1 mm is larger than indentation.depth = 4 mm"));
  EXPECT_THAT(message_with("region = \"nodule\"\nyoung", "region = \"noduel\"\nyoung"),
              HasSubstr("the nearest region is 'nodule'"));
  EXPECT_THAT(message_with("region = \"nodule\"\nyoung", "region = \"gel\"\nyoung"),
              HasSubstr("second material for region 'gel'"));
  EXPECT_THAT(message_with("region = \"nodule\"\n\n", "region = \"gel\"\n\n"),
              HasSubstr("two surfaces bound the region 'gel'"));
  EXPECT_THAT(message_with("\"1 mm\", \"1 mm\", \"1 mm\"]", "\"1 mm\", \"-2 mm\", \"1 mm\"]"),
              HasSubstr("low.y not below high.y"));
  EXPECT_THAT(message_with("element_size = \"4 mm\"", "element_size = \"9 mm\""),
              HasSubstr("larger than mesh.patch_spacing"));
  EXPECT_THAT(message_with("name = \"ball\"", "name = \"../ball\""), HasSubstr("cannot name"));
}

TEST(Case, LayersAndVoids) {
  const std::string layer = "[[layer]]\nthickness = \"2 mm\"\nregion = \"skin\"\n";
  EXPECT_THAT(message_with("[mesh]", layer + "[mesh]"), HasSubstr("region 'skin' has no material"));
  EXPECT_THAT(message_with("[mesh]", "[[layer]]\nthickness = \"0 mm\"\nregion = \"skin\"\n[mesh]"),
              HasSubstr("thickness"));
  EXPECT_THAT(message_with("region = \"nodule\"\n\n", "region = \"nodule\"\nvoid = true\n\n"),
              HasSubstr("region 'nodule' of a void"));
  EXPECT_THAT(message_with("region = \"nodule\"\n\n", "\n"),
              HasSubstr("an inclusion without a region"));
  EXPECT_THAT(message_with("region = \"nodule\"\n\n", "void = true\n\n"),
              HasSubstr("region 'nodule', which no surface bounds"));
}

TEST(Case, RejectsASharpEdgeWithoutFriction) {
  const std::string disc = "shape = \"disc\"\nradius = \"3 mm\"\n";
  EXPECT_THAT(message_of(with_tool(disc)), HasSubstr("sharp edge"));
  EXPECT_EQ(parse_case(with_tool(disc + "friction = \"no-slip\"\n"), "x.toml")
                .campaign.indentation.tool.edge_radius,
            0);
  EXPECT_EQ(parse_case(with_tool(disc + "edge_radius = \"0.03 mm\"\n"), "x.toml")
                .campaign.indentation.tool.shape,
            fem::ToolShape::Disc);
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
  EXPECT_EQ(c.materials.at(0).region, c.mesh.surface.region_name);
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

/// A case of records alone: no inside, no tool, no campaign.
const std::string kMeasured = "[measured]\nrecords = \"bench.toml\"\n";

TEST(MeasuredCase, HasNothingButRecordsAndALibrary) {
  const Case c = parse_case(kMeasured + "[certify]\nfriction = 0.2\n", "organ.toml");
  EXPECT_EQ(c.records, "bench.toml");
  EXPECT_EQ(c.name, "organ");
  EXPECT_EQ(parse_case(resolved_toml(c), "organ.toml"), c);
  EXPECT_THAT(resolved_toml(c), testing::Not(HasSubstr("[indentation]")));
}

TEST(MeasuredCase, RefusesWhatNeedsAnInside) {
  for (const std::string section : {"[tool]\nradius = \"4 mm\"\n", "[mesh]\n", "[solver]\n",
                                    "[[material]]\nyoung = \"1 kPa\"\npoisson = 0.4\n"}) {
    EXPECT_THAT(message_of(kMeasured + section), HasSubstr("with [measured]")) << section;
  }
  EXPECT_THAT(message_of(kMeasured + "[surface]\nfile = \"a.off\"\nunit = \"mm\"\n"),
              HasSubstr("both [measured] and [surface] are given"));
  EXPECT_THAT(message_of("[measured]\n"), HasSubstr("key 'measured.records' is missing"));
}

}  // namespace
}  // namespace palpate::app
