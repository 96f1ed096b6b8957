// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <vector>

#include "app/report/page_data.hpp"
#include "format/numbers.hpp"
#include "tests/support/bodies.hpp"
#include "tests/unit/app/report/columns.hpp"

namespace palpate::report {
namespace {

/// A drag at 2 mm that starts with a force against it, as where tissue leans.
SiteCurves dragged_site() {
  CurvePath path;
  path.kind = PathKind::Lateral;
  path.lateral_depth = 0.002;
  path.direction = {1, 0, 0};
  for (const double d : {0.0, 0.001, 0.002}) {
    CurveSample sample;
    sample.displacement = d;
    sample.force = {70 * d - 0.02, 0, 0.3};
    path.samples.push_back(sample);
  }
  SiteCurves site;
  site.vertex = 40;
  site.paths = {path};
  return site;
}

/// w = 0.4 + 100 z / m and h = 120 N/m rho: at 2 mm a drag is felt by 0.6 * 120 N/m.
TEST(SampleData, HasADragAtItsDepthFromItsStart) {
  Library library = test::plate(8, 0.08, [](const Vec3&) {
    NodeResponse node = test::wall_response(170, 120);
    node.lateral = {{0.0F, 0.01F}, {120.0F, 120.0F}};
    node.coupling = {0.4F, {{0.0F, 0.01F}, {100.0F, 100.0F}}};
    return node;
  });
  library.kind = ResponseKind::Coupled;
  Curves curves;
  curves.sites = {dragged_site()};
  const nlohmann::json data = sample_data(curves, library);
  const std::vector<float> displacement = floats(data.at("displacement"));
  const std::vector<float> force = floats(data.at("force")), rendered = floats(data.at("rendered"));
  ASSERT_EQ(rendered.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto d = static_cast<double>(displacement[i]);
    EXPECT_NEAR(static_cast<double>(force[i]), 70 * d, 1e-7);
    EXPECT_NEAR(static_cast<double>(rendered[i]), 0.6 * 120 * d, 1e-6);
  }
  EXPECT_TRUE(data.at("coupled").get<bool>());
}

CurvePath path_of(PathKind kind, int repeats, double uncertainty) {
  CurvePath path;
  path.kind = kind;
  path.repeats = repeats;
  path.direction = kind == PathKind::Normal ? Vec3{0, 0, -1} : Vec3{1, 0, 0};
  for (const double d : {0.0, 0.001}) {
    CurveSample sample;
    sample.displacement = d;
    sample.force_uncertainty = uncertainty;
    sample.force_scatter = 0.5 * uncertainty;
    path.samples.push_back(sample);
  }
  return path;
}

/// A measured press with a lateral path that nobody measured, one with a drag, and a computed site.
TEST(SampleData, TellsMeasuredFromAssumedAndComputedPaths) {
  const Library library =
      test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
  SiteCurves pressed, dragged, computed;
  pressed.vertex = 40;
  pressed.paths = {path_of(PathKind::Normal, 3, 0.02), path_of(PathKind::Lateral, 0, kUnknown)};
  dragged.vertex = 41;
  dragged.paths = {path_of(PathKind::Normal, 1, 0.03), path_of(PathKind::Lateral, 2, 0.04)};
  computed.vertex = 42;
  computed.paths = {path_of(PathKind::Normal, 0, kUnknown),
                    path_of(PathKind::Lateral, 0, kUnknown)};
  Curves curves;
  curves.sites = {pressed, dragged, computed};
  const nlohmann::json data = sample_data(curves, library).at("measurement");
  const std::string origin = from_base64(data.at("origin").front().get<std::string>()).value();
  EXPECT_EQ(origin, std::string("\1\2\1\1\0\0", 6));
  const std::vector<float> uncertainty = floats(data.at("uncertainty"));
  ASSERT_EQ(uncertainty.size(), 12U);
  EXPECT_EQ(uncertainty[1], 0.02F);
  EXPECT_EQ(uncertainty[7], 0.04F);
  EXPECT_EQ(floats(data.at("scatter"))[7], 0.02F);
  curves.sites = {computed};
  EXPECT_TRUE(sample_data(curves, library).at("measurement").is_null());
}

}  // namespace
}  // namespace palpate::report
