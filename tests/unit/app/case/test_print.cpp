// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <variant>

#include "tests/unit/app/case/good_case.hpp"

namespace palpate::app {
namespace {

TEST(ResolvedCase, ReadsBackEqual) {
  const Case c = parse_case(kGood, "ball.toml");
  const std::string resolved = resolved_toml(c);
  EXPECT_EQ(parse_case(resolved, "resolved"), c) << resolved;
  EXPECT_THAT(resolved, HasSubstr("max_knots = 12"));  // a default, spelled out
}

TEST(ResolvedCase, IsExactForAnyNumberAndText) {
  Case c = parse_case(kGood, "ball.toml");
  c.mesh.surface.path = "a \"quoted\"\\ name\twith\x01.off";
  c.mesh.patch_spacing = 0.1 / 3;
  c.materials[0].law.at("poisson") = 1.0 / 3;
  c.campaign.indentation.azimuths = {1.0 / 7, -2.0};
  std::get<mesher::PlaneSupport>(c.supports[0].where.shape).normal = {1.0 / 3, 0, -1e-20};
  const Case again = parse_case(resolved_toml(c), "resolved");
  EXPECT_EQ(again, c) << resolved_toml(c);
  EXPECT_EQ(again.mesh.surface.path, c.mesh.surface.path);
  EXPECT_EQ(again.mesh.patch_spacing, c.mesh.patch_spacing);
  EXPECT_EQ(again.materials[0].law.at("poisson"), 1.0 / 3);
  EXPECT_EQ(again.campaign.indentation.azimuths, c.campaign.indentation.azimuths);
  EXPECT_EQ(std::get<mesher::PlaneSupport>(again.supports[0].where.shape).normal,
            std::get<mesher::PlaneSupport>(c.supports[0].where.shape).normal);
}

// The text of a case is part of what identifies its curves.
TEST(ResolvedCase, WritesZeroAndOneAsFlags) {
  Case c = parse_case(kGood, "ball.toml");
  for (const auto& [times, text] :
       {std::pair{0, "false"}, {1, "true"}, {2, "2"}, {6, "6"}, {-1, "\"contact\""}}) {
    c.campaign.indentation.refine_under_tool = times;
    EXPECT_THAT(resolved_toml(c), HasSubstr(std::string("refine_under_tool = ") + text + "\n"));
    EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
  }
}

TEST(ResolvedCase, HasTheNamedSectionsOnly) {
  const Case c = parse_case(kGood, "ball.toml");
  Case other = c;
  other.fit.max_knots = 20;
  EXPECT_EQ(resolved_sections(c, {"mesh", "support"}),
            resolved_sections(other, {"mesh", "support"}));
  EXPECT_NE(resolved_sections(c, {"fit"}), resolved_sections(other, {"fit"}));
  EXPECT_THAT(resolved_sections(c, {"fit"}), Not(HasSubstr("ball")));
  EXPECT_THAT(resolved_sections(c, {""}), HasSubstr("ball"));
}

}  // namespace
}  // namespace palpate::app
