// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/first_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "app/case/case.hpp"
#include "tests/support/source_folder.hpp"

namespace palpate::app {
namespace {

FirstCase made(const std::string& file, const std::string& unit = "") {
  const BodyFile body = read_body_file(test::source_folder() / file, unit);
  const Base base = find_base(body.surface);
  return first_case(body, base, first_sizes(body.surface, base, 200), "a \"b\".obj", "");
}

TEST(FirstCase, IsShortAndSaysWhyOnEachLine) {
  std::istringstream lines(made("data/bodies/sofa/liver.obj").toml);
  int keys = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find('=') == std::string::npos) continue;
    ++keys;
    EXPECT_NE(line.find("  # "), std::string::npos) << line;
  }
  EXPECT_GE(keys, 10);
  EXPECT_LE(keys, 20);
}

TEST(FirstCase, HasTheGuessedUnitTheFileAndAPlaneThatTheBodyMeets) {
  const FirstCase first = made("data/bodies/sofa/liver.obj");
  const Case c = parse_case(first.toml, "liver.toml");
  EXPECT_EQ(c.mesh.surface.unit, 0.1);
  EXPECT_EQ(c.mesh.surface.path, "a \"b\".obj");
  EXPECT_THAT(first.toml, testing::HasSubstr("a GUESS from the size: the body is 215 mm long"));
  EXPECT_THAT(first.remarks.front(), testing::HasSubstr("GUESS"));
  ASSERT_EQ(c.supports.size(), 1U);
  EXPECT_LT(c.campaign.indentation.depth, c.campaign.indentation.tool.radius);
}

/// Edges of some 10 mm are felt by a tool as large; those of the pad are its rims.
TEST(FirstCase, NamesFacetsThatAToolFeels) {
  const FirstCase liver = made("data/bodies/sofa/liver.obj");
  EXPECT_THAT(liver.toml, testing::HasSubstr("# smooth = true"));
  EXPECT_THAT(liver.remarks.back(), testing::HasSubstr("facets: the edges of the file are 8.1"));
  EXPECT_FALSE(parse_case(liver.toml, "liver.toml").mesh.surface.smooth);
  EXPECT_THAT(made("data/bodies/pad.off").toml, testing::Not(testing::HasSubstr("smooth")));
}

/// A user who knows nothing of meshes gets forces that hardly depend on them.
TEST(FirstCase, RefinesUnderTheToolUnlessToldOtherwise) {
  const auto refined = [](const FirstCase& first) {
    return parse_case(first.toml, "case.toml").campaign.indentation.refine_under_tool;
  };
  EXPECT_EQ(refined(made("data/bodies/pad.off")), fem::IndentationSettings::kByContact);
  const BodyFile body = read_body_file(test::source_folder() / "data/bodies/pad.off", "");
  const Base base = find_base(body.surface);
  FirstSizes sizes = first_sizes(body.surface, base, 200);
  sizes.refinement = Refinement::Once;
  EXPECT_EQ(refined(first_case(body, base, sizes, "pad.off", "")), 1);
  sizes.refinement = Refinement::None;
  const FirstCase plain = first_case(body, base, sizes, "pad.off", "");
  EXPECT_EQ(refined(plain), 0);
  EXPECT_THAT(plain.toml, testing::HasSubstr("# refine_under_tool = \"contact\" would"));
}

TEST(FirstCase, MaterialIsThatOfTheTissueTable) {
  const Case c = parse_case(made("data/bodies/pad.off").toml, "pad.toml");
  const auto table = toml::parse_file((test::source_folder() / "data/materials.toml").string());
  const auto& tissues = *table["tissue"].as_array();
  const auto tissue = std::find_if(tissues.begin(), tissues.end(), [](const toml::node& node) {
    return (*node.as_table())["name"].value_or(std::string()) == "liver, human, elastography";
  });
  ASSERT_NE(tissue, tissues.end());
  const toml::table& entry = *tissue->as_table();
  const Case of_table =
      parse_case(made("data/bodies/pad.off")
                         .toml.substr(0, made("data/bodies/pad.off").toml.find("[[material]]")) +
                     "[[material]]\nlaw = \"" + entry["law"].value_or(std::string()) +
                     "\"\nyoung = \"" + entry["young"].value_or(std::string()) +
                     "\"\npoisson = " + std::to_string(entry["poisson"].value_or(0.0)) + "\n",
                 "pad.toml");
  EXPECT_EQ(resolved_sections(c, {"material"}), resolved_sections(of_table, {"material"}));
}

TEST(FirstCase, EveryRegionAndLabelHasAMaterial) {
  const Case mesh = parse_case(made("tests/data/meshes/gmsh/body_41.msh").toml, "mesh.toml");
  const BodyFile file =
      read_body_file(test::source_folder() / "tests/data/meshes/gmsh/body_41.msh", "");
  ASSERT_EQ(mesh.materials.size(), file.regions.size());
  for (std::size_t i = 0; i < file.regions.size(); ++i)
    EXPECT_EQ(mesh.materials[i].region, file.regions[i]);
  const Case image =
      parse_case(made("tests/data/meshes/images/ball_sform.nii.gz").toml, "image.toml");
  ASSERT_FALSE(image.mesh.image.labels.empty());
  EXPECT_EQ(image.materials.size(), image.mesh.image.labels.size());
}

}  // namespace
}  // namespace palpate::app
