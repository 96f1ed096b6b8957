// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/pressure_smoothness.hpp"

#include <gtest/gtest.h>

#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

class PressureSmoothness : public testing::Test {
 protected:
  QuadraticMesh mesh = make_quadratic_mesh(
      test::make_block(test::even(0, 0.02, 6), test::even(0, 0.02, 6), test::even(0, 0.02, 6)));
  std::vector<double> pressures(double constant, double gradient, double alternating) const {
    std::vector<double> p;
    for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
      double x = 0;
      for (std::size_t c = 0; c < 4; ++c) x += 0.25 * mesh.X(0, mesh.tetrahedra[e][c]);
      p.push_back(constant + gradient * x + (e % 2 == 0 ? alternating : -alternating));
    }
    return p;
  }
};

TEST_F(PressureSmoothness, LeavesAConstantPressureUnchanged) {
  const SmoothPressure smooth = smooth_pressure(mesh, pressures(700, 0, 0));
  for (const double p : smooth.pressure) EXPECT_NEAR(p, 700, 1e-9);
}

TEST_F(PressureSmoothness, DetectsACheckerboardOnAGradient) {
  const SmoothPressure gradient = smooth_pressure(mesh, pressures(700, 1e5, 0)),
                       alternating = smooth_pressure(mesh, pressures(700, 1e5, 1000));
  EXPECT_LT(gradient.roughness, 0.3);
  EXPECT_LT(gradient.alternation, kAlternating);
  EXPECT_GT(alternating.roughness, 0.5);
  EXPECT_GT(alternating.alternation, kAlternating);
}

TEST_F(PressureSmoothness, RemovesMostOfACheckerboard) {
  const auto exact = smooth_pressure(mesh, pressures(700, 1e5, 0)).pressure,
             smooth = smooth_pressure(mesh, pressures(700, 1e5, 1000)).pressure;
  double left = 0;
  for (std::size_t e = 0; e < exact.size(); ++e) left += std::pow(smooth[e] - exact[e], 2);
  EXPECT_LT(std::sqrt(left / static_cast<double>(exact.size())), 300);
}

}  // namespace
}  // namespace palpate::fem
