// SPDX-License-Identifier: AGPL-3.0-or-later
// A flat punch on bonded layers, and the balance of energy of every curve.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fem/at.hpp"
#include "fem/indentation.hpp"
#include "tests/support/block_body.hpp"
#include "tests/verification/record.hpp"
#include "tests/verification/round_layer.hpp"

namespace palpate::fem {
namespace {

constexpr double kYoung = 10e3, kRadius = 0.005;

/// F/(2 E* a d) of a flat frictionless punch, by radius over thickness.
double punch_factor(double poisson, double ratio, int rings) {
  const double h = kRadius / ratio, depth = 1e-4 * kRadius;
  const Body body = test::make_round_layer({kRadius, rings, 2, h, kRadius + 5 * h});
  const test::Pressed pressed =
      test::press(body, kYoung, poisson, {ToolShape::Disc, kRadius, 0, 0}, depth, 1);
  const double plane = kYoung / (1 - poisson * poisson);
  const double factor = pressed.force() / (2 * plane * kRadius * depth);
  std::printf("nu %.4f a/h %.1f: %d rings, %d nodes: %.4f\n", poisson, ratio, rings, pressed.nodes,
              factor);
  return factor;
}

struct Layer {
  double poisson, ratio, expected;
  int rings;
};

class BondedLayer : public testing::TestWithParam<Layer> {};

TEST_P(BondedLayer, CarriesAFlatPunch) {
  const auto [poisson, ratio, expected, rings] = GetParam();
  char name[80];
  std::snprintf(name, sizeof name, "F/(2 E* a d), nu = %.4g, a/h = %.1f", poisson, ratio);
  test::verify({"Flat punch on a bonded layer", name, "1", punch_factor(poisson, ratio, rings),
                expected, "[C] dual integral equations (Hayes 1972 [R])", 0.015});
}

INSTANTIATE_TEST_SUITE_P(Table, BondedLayer,
                         testing::Values(Layer{0.3, 0.2, 1.207, 4}, Layer{0.3, 0.6, 1.785, 4},
                                         Layer{0.3, 1, 2.484, 4}, Layer{0.3, 2, 4.353, 5},
                                         Layer{0.4999, 1, 3.619, 5}, Layer{0.4999, 2, 9.149, 5}));

class Balance : public testing::TestWithParam<ToolGeometry> {};

/// Elements nearly as large as the tool. Lateral paths: test_stuck_contact.cpp.
TEST_P(Balance, WorkOfTheToolIsTheStoredEnergy) {
  const ToolGeometry tool = GetParam();
  const auto across = test::even(-0.03, 0.03, 15);
  const Body body =
      test::make_block(across, across, {-0.03, -0.022, -0.015, -0.01, -0.006, -0.003, 0});
  CampaignSettings s;
  s.materials = {{"tissue", {kYoung, 0.49}}};
  s.indentation.tool = tool;
  s.indentation.depth = 0.006;
  s.indentation.increments = 10;
  s.indentation.held_depths.clear();
  std::int32_t site = 0;
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& x = body.nodes[at(body.response.node[v])];
    if (std::hypot(x[0] - 0.002, x[1] - 0.002) < 1e-6) site = static_cast<std::int32_t>(v);
  }
  const CampaignContext context(body, s, Engine::SharedFactor);
  const SiteCurves curves = solve_site(context, site, nullptr);
  ASSERT_EQ(curves.status, SiteStatus::Complete) << curves.reason;
  const CurveSample& end = curves.paths.front().samples.back();
  const std::string who = name_of(tool.shape) + (tool.edge_radius > 0 ? ", rounded edge" : "");
  test::verify({"Balance of energy on coarse elements (4 mm), nu = 0.49",
                "work of the tool over the stored energy, normal path to 6 mm, " + who, "1",
                end.tool_work / (end.strain_energy + end.contact_energy), 1, "[C] conservation",
                0.005});
}

INSTANTIATE_TEST_SUITE_P(Tools, Balance,
                         testing::Values(ToolGeometry{ToolShape::Sphere, 0.005, 0, 0},
                                         ToolGeometry{ToolShape::Disc, 0.005, 0.001, 0},
                                         ToolGeometry{ToolShape::Cylinder, 0.004, 0, 0.006}));

}  // namespace
}  // namespace palpate::fem
