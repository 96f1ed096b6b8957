// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/fidelity_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "format/sha256.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/app/csv_rows.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

fidelity::Fidelity result() {
  fidelity::Fidelity fidelity;
  fidelity::ComparedState state;
  state.point = 3;
  state.depth = 0.002;
  state.direct = {0, 0, 0.4};
  state.rendered = {0.03, 0, 0.44};
  state.scale = 0.4;
  fidelity.states = {state};
  state.kind = PathKind::Lateral;
  state.within_friction = false;
  fidelity.states.push_back(state);
  fidelity.rows = {{fidelity::kNormalOffNode, "total", 2, 0.011, 0.049, 0.125, 0.05, 3}};
  fidelity.left_out = {"point 4: no equilibrium"};
  return fidelity;
}

TEST(FidelityText, IsInPercent) {
  const std::string text = fidelity_text("a/library.h5", result(), {352, 118000});
  EXPECT_THAT(text, HasSubstr("a/library.h5: 118000 bytes, 352 bytes of curves a node\n"));
  EXPECT_THAT(text, HasSubstr("1.10 %   4.90 %  12.50 %"));
  EXPECT_THAT(text, HasSubstr("not complete: point 4: no equilibrium"));
}

/// |rendered - direct| = |(0.03, 0, 0.04)| = 0.05 of 0.4.
TEST(FidelityStates, HaveTheErrorOfTheWholeVector) {
  const std::string titled = fidelity_states_csv("library.h5", result(), true);
  const auto rows = test::csv_rows(titled);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("point"), "3");
  EXPECT_NEAR(std::stod(rows[0].at("relative_error")), 0.125, 1e-12);
  EXPECT_EQ(rows[0].at("kind"), "normal");
  EXPECT_EQ(rows[1].at("kind"), "oblique");
  EXPECT_EQ(rows[1].at("within_friction"), "0");
  // A further library adds its rows below the same titles.
  const std::string untitled = fidelity_states_csv("library.h5", result(), false);
  EXPECT_EQ(titled.substr(titled.find('\n') + 1), untitled);
}

TEST(FidelityText, StatesTheFloorAndWhereItComesFrom) {
  FidelityOptions options;
  EXPECT_THAT(floor_text(options, 0.0042), HasSubstr("4.20 mN (1.0 % of the median"));
  options.floor = 0.02;
  EXPECT_THAT(floor_text(options, 0.02), HasSubstr("or to 20.0 mN where"));
}

TEST(FidelityJson, NamesTheLibraryByItsBytes) {
  const samples::TemporaryFolder folder;
  std::ofstream(folder / "library.h5") << "abc";
  const auto json = fidelity_json(folder / "library.h5", result(), {352, 3});
  EXPECT_EQ(json.at("file"), "library.h5");
  EXPECT_EQ(json.at("sha256"), sha256("abc"));
  EXPECT_EQ(json.at("rows").at(0).at("p95"), 0.049);
  EXPECT_EQ(json.at("left_out").size(), 1u);
  FidelityOptions options;
  options.seed = 9;
  const auto heading = fidelity_heading(options, {0.02, 0.3}, {fidelity::HoldOutPoint{}});
  EXPECT_EQ(heading.at("seed"), 9);
  EXPECT_EQ(heading.at("friction"), 0.3);
  EXPECT_EQ(heading.at("points").size(), 1u);
  EXPECT_TRUE(heading.at("libraries").empty());
  EXPECT_EQ(heading.at("floor_N"), 0.02);
  EXPECT_EQ(heading.at("floor_fraction"), 0.01);
}

}  // namespace
}  // namespace palpate::app
