// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/time_tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace palpate::app {
namespace {

std::vector<ComparedHistory> compared() {
  ComparedHistory h{"a, b.csv", 3, "library", {}};
  h.comparison.time = {0, 1};
  h.comparison.travel = {0, 1e-3};
  h.comparison.measured = {0, 0.5};
  h.comparison.model = {0, 0.75};
  h.comparison.rmse = 0.2;
  h.comparison.holds = {{1, 9, 0.6, 0.65}};
  return {h};
}

TEST(TimeTables, HaveARowASample) {
  const std::string csv = time_comparison_csv(compared());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_NE(csv.find("\"a, b.csv\",3,library,1,0.001,0.5,0.75,0.25\n"), std::string::npos) << csv;
}

TEST(TimeTables, HaveNullForALossThatIsUnknown) {
  const auto json = time_comparison_json(compared()).at(0);
  EXPECT_TRUE(json.at("measured_loss_J").is_null());
  EXPECT_EQ(json.at("holds").at(0).at("measured_left"), 0.6);
  EXPECT_EQ(json.at("model_N").size(), 2u);
}

}  // namespace
}  // namespace palpate::app
