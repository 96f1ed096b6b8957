// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/couple.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fitting/response/site_samples.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

CurvePath lateral_path(double depth, double stiffness) {
  CurvePath path{PathKind::Lateral, depth, {1, 0, 0}, {}};
  for (int i = 0; i <= 6; ++i) {
    CurveSample sample;
    sample.displacement = 0.0005 * i;
    sample.force = {stiffness * sample.displacement, 0, -1};
    path.samples.push_back(sample);
  }
  return path;
}

TEST(Couple, LateralDepthsAreAscendingAndDistinct) {
  SiteCurves site;
  for (const double depth : {0.003, 0.001, 0.003, 0.002})
    site.paths.push_back(lateral_path(depth, 50));
  EXPECT_EQ(lateral_depths(site), (std::vector<double>{0.001, 0.002, 0.003}));
}

TEST(Couple, APowerLawOfDepthIsRecoveredBetweenTheDepths) {
  // f = 50 (z/z_1)^0.8 rho N at depths z_0, z_1, z_2: linear in the logarithms.
  SiteCurves site;
  const auto w = [](double z) { return std::pow(z / 0.002, 0.8); };
  for (const double z : {0.001, 0.002, 0.004}) site.paths.push_back(lateral_path(z, 50 * w(z)));
  const CoupledLateral coupled = fit_coupled(site, {}, 0.005, {1e-3, 1e-5, 12, false}, "test");
  const runtime::CompiledCurve f(coupled.lateral);
  const runtime::CompiledCurve weight(coupled.coupling.curve,
                                      static_cast<double>(coupled.coupling.base));
  for (const double rho : {0.001, 0.002, 0.003})
    EXPECT_NEAR(f.force(rho), 50 * rho, 1e-3 * 50 * rho);
  for (const double z : {0.001, 0.0015, 0.002, 0.003, 0.004})
    EXPECT_NEAR(weight.force(z), w(z), 0.025) << z;
  EXPECT_NEAR(weight.force(0.005), w(0.004) * std::sqrt(1.25), 0.05);  // beyond: sqrt
}

TEST(Couple, LevelOffMakesTheCouplingConstantBeyondItsLastKnot) {
  CouplingCurve rising{0.5F, {{0.0F, 0.002F, 0.004F}, {0, 100, 80}}};
  level_off(rising);
  EXPECT_EQ(rising.curve.slope.back(), 0.0F);
  EXPECT_FLOAT_EQ(rising.curve.knot.back(), 1.25F * 0.004F);
  const runtime::CompiledCurve w(rising.curve, 0.5);
  EXPECT_DOUBLE_EQ(w.force(0.01), w.force(0.02));
  CouplingCurve level{0.5F, {{0.0F, 0.002F, 0.004F}, {0, 100, 1}}};  // almost constant already
  level_off(level);
  EXPECT_EQ(level.curve.knot.size(), 3u);
  EXPECT_EQ(level.curve.slope.back(), 0.0F);
}

}  // namespace
}  // namespace palpate::fitting
