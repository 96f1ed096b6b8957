// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <vector>

#include "app/report/page_data.hpp"
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

}  // namespace
}  // namespace palpate::report
