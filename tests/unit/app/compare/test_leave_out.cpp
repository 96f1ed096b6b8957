// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/compare/leave_out.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/unit/format/refusal.hpp"

namespace palpate::app {
namespace {

constexpr int kColumns = 8, kRows = 7;
constexpr double kSpacing = 0.005, kDeepest = 0.003;

using Stiffness = std::function<double(double x, double y)>;

struct Measured {
  Library library;
  Curves curves;
};

/// A flat patch of sites whose force is proportional to the depth. `scatter` is the relative
/// deviation of each press.
Measured patch(const Stiffness& stiffness, double scatter, int rows = kRows) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  Measured m;
  m.library.name = "patch";
  m.library.tool_shape = m.curves.tool.shape = "sphere";
  m.library.tool_radius = m.curves.tool.radius = 0.004;
  for (int i = 0; i < kColumns * rows; ++i) {
    const double x = (i % kColumns) * kSpacing + 1e-4 * (i % 3), y = (i / kColumns) * kSpacing;
    const double s = stiffness(x, y) * (1 + scatter * normal(random));
    m.library.positions.push_back({x, y, 0});
    m.library.inward.push_back({0, 0, -1});
    NodeResponse response;
    response.status = ResponseStatus::Fitted;
    response.normal.knot = {0, static_cast<float>(kDeepest)};
    response.normal.slope = {static_cast<float>(s), static_cast<float>(s)};
    m.library.responses.push_back(response);
    CurvePath path;
    path.direction = {0, 0, -1};
    for (int k = 0; k <= 6; ++k) {
      CurveSample sample;
      sample.displacement = kDeepest * k / 6;
      sample.force = s * sample.displacement * path.direction;
      path.samples.push_back(sample);
    }
    m.curves.sites.push_back({i, SiteStatus::Complete, "", 0, {path}});
  }
  return m;
}

double linear(double x, double y) {
  return 300 + 4000 * x - 2000 * y;
}

TEST(LeaveOut, PredictsALinearFieldExactly) {
  const Measured m = patch(linear, 0);
  const LeaveOut result = leave_sites_out(m.library, m.curves);
  // Float slopes.
  EXPECT_LT(result.all.worst, 1e-6);
  EXPECT_EQ(result.deepest.count, static_cast<std::size_t>((kColumns - 2) * (kRows - 2)))
      << "all but those of the border";
  EXPECT_EQ(result.all.count, 6 * result.deepest.count);
  // Neighbours along a line of the grid differ by 4000 kSpacing of some 350, or half of that.
  EXPECT_GT(result.neighbours_deepest.median, 0.02);
  EXPECT_LT(result.neighbours_deepest.worst, 0.15);
  for (const LeftOutSite& site : result.sites)
    for (const std::int32_t vertex : site.from) EXPECT_NE(vertex, site.vertex);
}

/// A prediction from three sites of the same scatter misses by at least that of the site itself.
TEST(LeaveOut, IsNotBelowTheScatterOfAPress) {
  constexpr double kScatter = 0.05;
  const Measured m = patch(linear, kScatter);
  const LeaveOut result = leave_sites_out(m.library, m.curves);
  constexpr double kMedianOfNormal = 0.6745;
  EXPECT_GT(result.deepest.median, 0.8 * kMedianOfNormal * kScatter);
  // At most as a prediction from one other site: sqrt(2); and a median of 30 has its own scatter.
  EXPECT_LT(result.deepest.median, 1.4 * std::sqrt(2.0) * kMedianOfNormal * kScatter);
}

TEST(LeaveOut, DoesNotLookAtTheSiteItself) {
  Measured m = patch(linear, 0);
  const LeaveOut before = leave_sites_out(m.library, m.curves);
  const std::size_t middle = 3 * kColumns + 4;
  for (float& slope : m.library.responses[middle].normal.slope) slope *= 3;
  const LeaveOut after = leave_sites_out(m.library, m.curves);
  EXPECT_EQ(after.sites[middle].predicted, before.sites[middle].predicted);
  EXPECT_NE(after.sites[middle + 1].predicted, before.sites[middle + 1].predicted);
}

TEST(LeaveOut, ComparesCurvesOfThePredictedSitesAlone) {
  const Measured m = patch(linear, 0.05);
  const LeaveOut result = leave_sites_out(m.library, m.curves);
  const LeaveOutSets sets = sets_of(result, m.library, m.curves);
  const compare::Comparison comparison = compare::compare(sets.measured, sets.predicted, {});
  EXPECT_EQ(comparison.curves.size(), result.deepest.count);
  EXPECT_EQ(comparison.unmatched.size(), result.sites.size() - result.deepest.count);
  for (const compare::CurveComparison& curve : comparison.curves)
    EXPECT_EQ(curve.vertex, curve.model_vertex);
  const auto json = leave_out_json(result, m.library);
  EXPECT_EQ(json["predicted_sites"], result.deepest.count);
  EXPECT_NE(leave_out_text(result).find("30 of 56 sites predicted"), std::string::npos);
}

TEST(LeaveOut, RefusesTwoRows) {
  Measured m = patch(linear, 0, 2);
  // Both rows are bent outwards, so that no site lies between others of its row.
  for (std::size_t i = 0; i < m.library.positions.size(); ++i) {
    const double u = 2.0 * static_cast<double>(i % kColumns) / (kColumns - 1) - 1;
    m.library.positions[i][1] += (i < kColumns ? -0.002 : 0.002) * (1 - u * u);
  }
  samples::expect_refusal([&] { leave_sites_out(m.library, m.curves); }, ErrorKind::Configuration,
                          "patch", "no site has others all around it");
}

}  // namespace
}  // namespace palpate::app
