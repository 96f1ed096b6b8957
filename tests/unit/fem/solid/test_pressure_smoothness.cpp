// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/pressure_smoothness.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

Body block() {
  Body body =
      test::make_block(test::even(0, 0.02, 4), test::even(0, 0.02, 4), test::even(0, 0.02, 4));
  body.region_names = {"tissue", "nodule"};
  for (std::size_t e = 0; e < body.tetrahedra.size(); e += 5) body.tetrahedron_region[e] = 1;
  return body;
}

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

TEST(SmoothPressure, LeavesAConstantAndDetectsAlternatingPressures) {
  Body body = block();
  body.tetrahedron_region.assign(body.tetrahedra.size(), 0);
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  const std::vector<double> constant(mesh.tetrahedra.size(), 5);
  const SmoothPressure same = smooth_pressure(mesh, constant);
  for (const double p : same.pressure) EXPECT_NEAR(p, 5, 1e-12);
  std::vector<double> alternating;
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e)
    alternating.push_back(e % 2 == 0 ? 1 : -1);
  const SmoothPressure flat = smooth_pressure(mesh, alternating);
  EXPECT_GT(flat.roughness, 0.9);
  EXPECT_GT(flat.alternation, kAlternating);
}

/// Its only change to a linear field is at the boundary, where a node has elements on one side.
TEST(SmoothPressure, ChangesALinearFieldLittle) {
  Body body = block();
  body.tetrahedron_region.assign(body.tetrahedra.size(), 0);
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  std::vector<double> linear;
  for (const auto& t : mesh.tetrahedra) {
    double x = 0;
    for (std::size_t c = 0; c < 4; ++c) x += 0.25 * mesh.X(0, t[c]);
    linear.push_back(x);
  }
  EXPECT_LT(smooth_pressure(mesh, linear).roughness, 0.2);
}

/// A jump between regions is physical.
TEST(SmoothPressure, LeavesAJumpBetweenRegions) {
  const Body body = block();
  const QuadraticMesh mesh = make_quadratic_mesh(body);
  std::vector<double> jump;
  for (const auto region : mesh.region) jump.push_back(region == 0 ? 1 : 3);
  EXPECT_LT(smooth_pressure(mesh, jump).roughness, 1e-12);
}

}  // namespace
}  // namespace palpate::fem
