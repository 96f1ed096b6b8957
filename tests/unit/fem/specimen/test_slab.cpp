// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/specimen/slab.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/format/refusal.hpp"

namespace palpate::fem {
namespace {

constexpr double kRadius = 0.004, kShear = 1000, kPoisson = 0.49;

SlabPress press_of(double thickness, std::vector<double> depths) {
  SlabPress press;
  press.tool.radius = kRadius;
  press.law = LawConstants(2 * (1 + kPoisson) * kShear, kPoisson);
  press.thickness = thickness;
  press.depths = std::move(depths);
  return press;
}

double hertz(double depth) {
  const double young = 2 * (1 + kPoisson) * kShear;
  return 4.0 / 3.0 * young / (1 - kPoisson * kPoisson) * std::sqrt(kRadius) * std::pow(depth, 1.5);
}

/// An incompressible layer that is bonded to its base [Dimitriadis et al. 2002, eq. 13], over
/// Hertz.
double bonded_layer(double chi) {
  return 1 + 1.133 * chi + 1.283 * chi * chi + 0.769 * std::pow(chi, 3) + 0.0975 * std::pow(chi, 4);
}

TEST(Slab, IsAHalfSpaceWhereItIsThick) {
  const SlabForces found = press_slab(press_of(15 * kRadius, {0.1 * kRadius}));
  ASSERT_EQ(found.force.size(), 1U) << found.reason;
  const double depth = 0.1 * kRadius;
  const double chi = std::sqrt(kRadius * depth) / (15 * kRadius);
  EXPECT_NEAR(found.force[0], hertz(depth) * bonded_layer(chi), 0.03 * hertz(depth));
}

TEST(Slab, IsABondedLayerWhereItIsThin) {
  const double depth = 0.1 * kRadius, thickness = 1.2 * kRadius;
  const SlabForces found = press_slab(press_of(thickness, {depth}));
  ASSERT_EQ(found.force.size(), 1U) << found.reason;
  const double expected = hertz(depth) * bonded_layer(std::sqrt(kRadius * depth) / thickness);
  EXPECT_NEAR(found.force[0], expected, 0.04 * expected);
}

TEST(Slab, RefusesAPressThroughIt) {
  samples::expect_refusal([] { press_slab(press_of(0.001, {0.0015})); }, ErrorKind::Configuration,
                          "slab", "pressed by 1.50 mm");
  SlabPress disc = press_of(0.01, {0.001});
  disc.tool.shape = ToolShape::Disc;
  samples::expect_refusal([&] { press_slab(disc); }, ErrorKind::Configuration, "slab", "no sphere");
}

}  // namespace
}  // namespace palpate::fem
