// SPDX-License-Identifier: AGPL-3.0-or-later
// Two elastic spheres pressed together (code_aster SSNV104): R = 50 mm, E = 20 GPa, nu = 0.3, an
// approach of 4 mm: a = 10 mm, p0 = 2798.3 MPa. By symmetry each of them meets a rigid plane
// half-way, which is here the flat end of a disc. The published case is computed with small
// strains, which Hertz's theory assumes; the strains of the solid would reach a seventh. The test
// presses a hundredth as far: by a = sqrt(R d) and p0 = 2 E*/pi sqrt(d/R) both are a tenth.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "format/to_index.hpp"
#include "tests/support/prism_body.hpp"
#include "tests/verification/record.hpp"
#include "tests/verification/round_layer.hpp"

namespace palpate::fem {
namespace {

constexpr double kRadius = 0.05, kYoung = 20e9, kPoisson = 0.3, kDepth = 2e-5;
constexpr double kRim = 1.4;  ///< rad from the pole, where dome and equator are joined by a rim

/// Arcs from the pole of the dome: even within the contact, then ever wider.
std::vector<double> arcs(double fine) {
  std::vector<double> s;
  double step = fine;
  for (double next = fine; next < kRim * kRadius - 0.5 * step; next += step) {
    s.push_back(next);
    if (next > 1.1e-3) step *= 2;
  }
  s.push_back(kRim * kRadius);
  return s;
}

std::vector<double> depths(double fine) {
  std::vector<double> depth{0};
  double step = fine / kRadius;
  for (double next = step; next < 1 - 0.5 * step; next += step) {
    depth.push_back(next);
    if (next > 0.015) step *= 2;
  }
  depth.push_back(1);
  return depth;
}

/// The upper half of a ball, its equator fixed.
Body half_ball(double fine) {
  const test::Triangulation disc = test::rings(arcs(fine), 3);
  const std::vector<double> below = depths(fine);
  const int layers = static_cast<int>(below.size()) - 1;
  Body body = test::make_prisms(disc, layers, [&](const Vec3& x, int layer) {
    const double arc = std::hypot(x[0], x[1]), angle = arc / kRadius;
    const double down = below[to_index(layers - layer)];
    const double out = down * arc / kRim + (1 - down) * kRadius * std::sin(angle);
    const double scale = arc > 0 ? out / arc : 0;
    return Vec3{scale * x[0], scale * x[1], (1 - down) * kRadius * std::cos(angle)};
  });
  const auto count = static_cast<std::int32_t>(disc.points.size());
  for (std::int32_t i = 0; i < count; ++i) body.fixed_nodes.push_back(i);
  body.response.node = {count * layers};
  body.response.inward = {{0, 0, -1}};
  body.response.is_site = {1};
  return body;
}

TEST(TwoSpheres, HaveThePressureAndTheRadiusOfHertz) {
  const Body body = half_ball(2.5e-4);
  const ToolGeometry plane{ToolShape::Disc, 2e-3, 1e-4, 0};
  const test::Pressed pressed = test::press(body, kYoung, kPoisson, plane, kDepth, 2);
  ASSERT_EQ(pressed.curves.status, SiteStatus::Complete);
  const CurveSample& end = pressed.curves.paths.front().samples.back();
  const std::string problem =
      "Two spheres of R = 50 mm, E = 20 GPa, nu = 0.3, a hundredth of an approach of 4 mm";
  test::verify({problem, "radius of contact", "mm", 1e3 * std::sqrt(end.contact_area / M_PI), 1,
                test::Reference::Published,
                "code_aster SSNV104: 10 mm at an approach of 4 mm, times sqrt(1/100)", 0.02});
  // The peak of Hertz's pressure follows from force and area, p0 = 3 F/(2 pi a^2): no row of its
  // own.
  EXPECT_NEAR(1.5e-6 * pressed.force() / end.contact_area, 279.83, 0.02 * 279.83);
  const double hertz =
      4.0 / 3 * kYoung / (1 - kPoisson * kPoisson) * std::sqrt(kRadius) * std::pow(kDepth, 1.5);
  test::verify({problem, "force", "N", pressed.force(), hertz, test::Reference::ClosedForm,
                "Hertz 1882", 0.02});
}

}  // namespace
}  // namespace palpate::fem
