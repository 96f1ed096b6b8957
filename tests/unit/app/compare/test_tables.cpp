// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/tables.hpp"

#include <gtest/gtest.h>

#include "tests/unit/app/csv_rows.hpp"

namespace palpate::app {
namespace {

/// Two curves F = k d at one site, the model stiffer by a tenth.
compare::Comparison comparison(double scatter) {
  const auto set = [&](double k) {
    compare::ComparedCurve curve;
    for (int i = 0; i <= 20; ++i) {
      curve.displacement.push_back(1e-4 * i);
      curve.force.push_back(k * 1e-4 * i);
      curve.uncertainty.push_back(kUnknown);
      curve.scatter.push_back(scatter);
    }
    compare::ComparedSet one;
    one.name = k > 100 ? "model" : "reference";
    one.sites = {{5, {0, 0, 0}, {curve}}};
    return one;
  };
  return compare::compare(set(100), set(110), {});
}

TEST(ComparisonTables, HaveARowACurveAndARowAPoint) {
  const auto result = comparison(kUnknown);
  const auto curves = test::csv_rows(comparison_csv(result));
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].at("vertex"), "5");
  EXPECT_EQ(curves[0].at("kind"), "normal");
  EXPECT_NEAR(std::stod(curves[0].at("range_m")), 2e-3, 1e-12);
  // The worst point is the last one: 10 N/m times 2 mm.
  EXPECT_NEAR(std::stod(curves[0].at("worst_difference_N")), 0.02, 1e-9);
  // Areas under the lines, k d^2/2.
  EXPECT_NEAR(std::stod(curves[0].at("energy_reference_J")), 100 * 2e-3 * 2e-3 / 2, 1e-12);
  EXPECT_NEAR(std::stod(curves[0].at("energy_model_J")), 110 * 2e-3 * 2e-3 / 2, 1e-12);
  const auto points = test::csv_rows(comparison_points_csv(result));
  ASSERT_EQ(points.size(), result.curves[0].points.size());
  for (const test::CsvRow& point : points)
    EXPECT_NEAR(std::stod(point.at("difference_N")), 0.1 * std::stod(point.at("reference_N")),
                1e-12);
}

TEST(ComparisonTables, LeaveUnknownFieldsEmpty) {
  const auto unknown = test::csv_rows(comparison_csv(comparison(kUnknown)))[0];
  EXPECT_EQ(unknown.at("scatter_N"), "");
  EXPECT_EQ(unknown.at("within_uncertainty_fraction"), "");
  const auto known = test::csv_rows(comparison_csv(comparison(0.003)))[0];
  EXPECT_NEAR(std::stod(known.at("scatter_N")), 0.003, 1e-12);
}

TEST(ComparisonJson, HasWhatTheTablesHave) {
  const auto result = comparison(kUnknown);
  const auto json = comparison_json(result, {});
  EXPECT_EQ(json.at("artifact"), "palpate.comparison");
  EXPECT_EQ(json.at("model"), "model");
  EXPECT_EQ(json.at("jnd"), 0.07);
  ASSERT_EQ(json.at("curves").size(), 1u);
  const auto& curve = json.at("curves").at(0);
  EXPECT_EQ(curve.at("points").size(), result.curves[0].points.size());
  EXPECT_TRUE(curve.at("scatter_N").is_null());
  for (const auto& at : curve.at("stiffness")) {
    EXPECT_NEAR(at.at("reference_N_per_m").get<double>(), 100, 1e-6);
    EXPECT_NEAR(at.at("model_N_per_m").get<double>(), 110, 1e-6);
  }
}

}  // namespace
}  // namespace palpate::app
