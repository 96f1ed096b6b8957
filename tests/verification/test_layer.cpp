// SPDX-License-Identifier: AGPL-3.0-or-later
// A flat frictionless punch on bonded layers. The radius of its edge is a/1000, because a sharp
// edge needs no-slip contact.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fem/campaign/indentation.hpp"
#include "tests/verification/record.hpp"
#include "tests/verification/round_layer.hpp"

namespace palpate::fem {
namespace {

constexpr double kYoung = 10e3, kRadius = 0.005;

/// F/(2 E* a d) of a flat frictionless punch, by radius over thickness.
double punch_factor(double poisson, double ratio, int rings) {
  const double h = kRadius / ratio, depth = 1e-4 * kRadius;
  const Body body = test::make_round_layer({kRadius, rings, 2, h, kRadius + 3.5 * h});
  // The shared factor is of little use to one press of a nearly incompressible layer.
  const Engine engine = poisson > 0.49 ? Engine::Direct : Engine::SharedFactor;
  const test::Pressed pressed = test::press(
      body, kYoung, poisson, {ToolShape::Disc, kRadius, 1e-3 * kRadius, 0}, depth, 1, engine);
  const double plane = kYoung / (1 - poisson * poisson);
  return pressed.force() / (2 * plane * kRadius * depth);
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
  test::verify({"Flat punch on a bonded layer, edge rounded by a/1000", name, "1",
                punch_factor(poisson, ratio, rings), expected, test::Reference::OtherSolver,
                "dual integral equations recalled from Hayes 1972", 0.015});
}

INSTANTIATE_TEST_SUITE_P(Table, BondedLayer,
                         testing::Values(Layer{0.3, 0.2, 1.207, 4}, Layer{0.3, 0.4, 1.473, 4},
                                         Layer{0.3, 0.6, 1.785, 4}, Layer{0.3, 0.8, 2.126, 4},
                                         Layer{0.3, 1, 2.484, 4}, Layer{0.3, 1.5, 3.409, 5},
                                         Layer{0.3, 2, 4.353, 5}, Layer{0.4999, 0.2, 1.281, 4},
                                         Layer{0.4999, 0.4, 1.684, 4}, Layer{0.4999, 0.6, 2.213, 5},
                                         Layer{0.4999, 0.8, 2.860, 5}, Layer{0.4999, 1, 3.619, 5},
                                         Layer{0.4999, 1.5, 6.003, 5}, Layer{0.4999, 2, 9.149, 5}));

}  // namespace
}  // namespace palpate::fem
