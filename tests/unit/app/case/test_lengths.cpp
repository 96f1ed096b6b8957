// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/case/lengths.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/app/case/good_case.hpp"

namespace palpate::app {
namespace {

const std::string kPatches = "patch_spacing = \"8 mm\"\nelement_size = \"4 mm\"\n";
const std::string kPaths = "depth = \"4 mm\"\nlateral_depths = [\"1 mm\", \"3.3 mm\"]\n";

/// kGood without any length of its mesh and its paths.
std::string without_lengths() {
  return replaced(replaced(kGood, kPatches, ""), kPaths, "") +
         "[sampling]\nmethod = \"adaptive\"\n";
}

SizeOfBody box(double x, double y, double z) {
  return [=](const Case&) { return BodySize{std::hypot(x, y, z), std::min({x, y, z})}; };
}

/// Every length of the case, in one order.
std::vector<double> lengths_of(const Case& c) {
  const fem::IndentationSettings& paths = c.campaign.indentation;
  std::vector<double> all{c.mesh.patch_spacing, c.mesh.element_size,  paths.tool.radius,
                          paths.depth,          paths.lateral_travel, c.sampling.initial_spacing};
  all.insert(all.end(), paths.lateral_depths.begin(), paths.lateral_depths.end());
  return all;
}

TEST(Lengths, GrowWithTheBody) {
  const Case c = parse_case(without_lengths(), "ball.toml", box(0.05, 0.05, 0.02));
  const Case large = parse_case(without_lengths(), "ball.toml", box(6.4, 6.4, 2.56));
  const auto small_lengths = lengths_of(c), large_lengths = lengths_of(large);
  ASSERT_EQ(small_lengths.size(), 9U);
  ASSERT_EQ(large_lengths.size(), 9U);
  for (std::size_t i = 0; i < small_lengths.size(); ++i)
    EXPECT_NEAR(large_lengths[i] / small_lengths[i], 128, 1e-9) << i;
}

TEST(Lengths, OfABlockAreThoseOfThePage) {
  const Case c = parse_case(without_lengths(), "ball.toml", box(0.3, 0.4, 0.2));
  const double patch = std::hypot(0.3, 0.4, 0.2) / 15;
  const fem::IndentationSettings& paths = c.campaign.indentation;
  EXPECT_DOUBLE_EQ(c.mesh.patch_spacing, patch);
  EXPECT_DOUBLE_EQ(c.mesh.element_size, patch / 2);
  EXPECT_DOUBLE_EQ(paths.tool.radius, 0.65 * patch);
  EXPECT_DOUBLE_EQ(paths.depth, 0.4 * patch);
  EXPECT_DOUBLE_EQ(paths.lateral_travel, 0.2 * patch);
  EXPECT_THAT(c.derived, HasSubstr("patch_spacing = 35.9 mm"));
}

TEST(Lengths, OfAThinBodyKeepTheToolWithinAFifthOfIt) {
  const Case c = parse_case(without_lengths(), "ball.toml", box(0.3, 0.4, 0.01));
  EXPECT_DOUBLE_EQ(c.campaign.indentation.depth, 0.002);
  EXPECT_DOUBLE_EQ(c.campaign.indentation.lateral_depths.back(), 0.002);
}

TEST(Lengths, ThatAreGivenStayAndTheOthersFollowThem) {
  const Case c = parse_case(kGood, "ball.toml", [](const Case&) -> BodySize {
    ADD_FAILURE() << "no length depends on the body";
    return {};
  });
  EXPECT_DOUBLE_EQ(c.mesh.patch_spacing, 0.008);
  EXPECT_DOUBLE_EQ(c.campaign.indentation.tool.radius, 0.0052);
  EXPECT_DOUBLE_EQ(c.campaign.indentation.lateral_travel, 0.002);
  EXPECT_EQ(c.campaign.indentation.lateral_depths, (std::vector<double>{0.001, 0.0033}));
}

TEST(Lengths, MayBeWrittenAsAuto) {
  const std::string text = replaced(replaced(kGood, kPatches, "patch_spacing = \"auto\"\n"), kPaths,
                                    "depth = \"auto\"\nlateral_depths = \"auto\"\n") +
                           "[sampling]\nmethod = \"adaptive\"\n";
  const SizeOfBody size = box(0.3, 0.4, 0.2);
  EXPECT_EQ(parse_case(text, "ball.toml", size), parse_case(without_lengths(), "ball.toml", size));
  EXPECT_THAT(message_of(replaced(kGood, "depth = \"4 mm\"", "depth = \"automatic\"")),
              HasSubstr("indentation.depth"));
}

TEST(Lengths, StayAutoWithoutABodyAndReadBackSo) {
  const Case c = parse_case(without_lengths(), "ball.toml");
  EXPECT_TRUE(needs_body_size(c));
  EXPECT_TRUE(std::isnan(c.campaign.indentation.depth));
  EXPECT_THAT(resolved_toml(c), HasSubstr("patch_spacing = \"auto\""));
  EXPECT_THAT(resolved_toml(c), HasSubstr("lateral_depths = \"auto\""));
  EXPECT_EQ(parse_case(resolved_toml(c), "resolved"), c);
}

}  // namespace
}  // namespace palpate::app
