// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/heavy_rod.hpp"

#include <Eigen/Core>
#include <cmath>

#include "tests/support/prism_body.hpp"

namespace palpate::test {

namespace {

/// phi, phi', along, across.
using RodState = Eigen::Vector4d;

/// From the tip to the clamp by the method of Runge and Kutta.
RodState at_clamp(double stiffness_ratio, double length, double tip_angle) {
  constexpr int kSteps = 2000;
  const auto slope = [&](double s, const RodState& y) {
    return RodState(y[1], stiffness_ratio * (length - s) * std::sin(y[0]), std::cos(y[0]),
                    std::sin(y[0]));
  };
  const double h = -length / kSteps;
  RodState y(tip_angle, 0, 0, 0);
  for (int i = 0; i < kSteps; ++i) {
    const double s = length + i * h;
    const RodState a = slope(s, y), b = slope(s + h / 2, y + h / 2 * a),
                   c = slope(s + h / 2, y + h / 2 * b), d = slope(s + h, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

}  // namespace

Body make_rod(double radius, double length, int layers) {
  const double corner = radius * std::sqrt((M_PI / 6) / std::sin(M_PI / 6));
  const Triangulation section = rings({corner / 2, corner}, 2);
  Body body = make_prisms(section, layers, [&](const Vec3& point, int layer) {
    return Vec3{point[0], point[1], length * layer / layers};
  });
  body.name = "rod";
  for (std::size_t i = 0; i < section.points.size(); ++i)
    body.fixed_nodes.push_back(static_cast<std::int32_t>(i));
  return body;
}

RodTip heavy_elastica(double weight, double bending, double length, double clamped) {
  double low = 0, high = clamped;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (at_clamp(weight / bending, length, middle)[0] < clamped ? low : high) = middle;
  }
  const RodState y = at_clamp(weight / bending, length, low);
  return {-y[3], -y[2]};
}

}  // namespace palpate::test
