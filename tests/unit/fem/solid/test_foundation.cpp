// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/foundation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/solid/solid_model.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/equilibrium.hpp"

namespace palpate::fem {
namespace {

/// A column along z from 0 to `height`, its base on springs instead of fixed.
Body sprung_column(double height, double normal_stiffness, double tangential_stiffness) {
  Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, height, 4));
  body.fixed_nodes.clear();
  for (std::size_t f = 0; f < body.boundary.size(); ++f) {
    const Triangle& facet = body.boundary[f];
    if (body.nodes[to_index(facet[0])][2] + body.nodes[to_index(facet[1])][2] +
            body.nodes[to_index(facet[2])][2] >
        0)
      continue;
    body.foundation.push_back(
        {static_cast<std::int32_t>(f), normal_stiffness, tangential_stiffness});
  }
  return body;
}

/// Prescribes two components everywhere as 0, and the third at the top.
std::vector<test::Prescribed> moved_top(const SolidModel& model, int axis, double value) {
  const double top = model.mesh().X.row(2).maxCoeff();
  std::vector<test::Prescribed> prescribed;
  for (int node = 0; node < model.mesh().nodes(); ++node)
    for (int i = 0; i < 3; ++i) {
      const bool on_top = model.mesh().X(2, node) > top - 1e-9;
      if (i != axis) prescribed.push_back({model.equation(node) + i, 0});
      if (i == axis && on_top) prescribed.push_back({model.equation(node) + i, value});
    }
  return prescribed;
}

/// A column confined to its cross-section is a spring in series with its Winkler foundation:
/// P(lambda) = k w, w + (1 - lambda) H = d, with the neo-Hookean P = mu/2 (2/3 lambda^(-5/3) (2 +
/// lambda^2) - 2 lambda^(1/3)) + kappa/2 (1/lambda - lambda).
TEST(Foundation, IsASpringInSeriesWithAConfinedColumn) {
  constexpr double kHeight = 0.04, kStiffness = 5e5, kArea = 4e-4;
  const double mu = 10e3 / 2.6, kappa = 10e3 / (3 * 0.4);
  const auto stress = [&](double l) {
    return mu * (std::pow(l, -5.0 / 3) * (2 + l * l) / 3 - std::cbrt(l)) +
           0.5 * kappa * (1 / l - l);
  };
  const auto energy = [&](double l) {
    return 0.5 * mu * (std::pow(l, -2.0 / 3) * (2 + l * l) - 3) +
           0.25 * kappa * (l * l - 1 - 2 * std::log(l));
  };
  const Body body = sprung_column(kHeight, kStiffness, 0);
  const SolidModel model(body, {NeoHookean::from_young_poisson(10e3, 0.3, "t")});
  for (const double d : {1e-5, 0.004, 0.012}) {
    double low = 0.2, high = 1;
    for (int i = 0; i < 100; ++i) {
      const double l = 0.5 * (low + high);
      (stress(l) < kStiffness * (d - (1 - l) * kHeight) ? high : low) = l;
    }
    const double compression = d - (1 - low) * kHeight;
    Displacement u = Displacement::Zero(3, model.mesh().nodes());
    test::equilibrate(model, test::Loads::Zero(3, model.mesh().nodes()), moved_top(model, 2, -d),
                      u);
    Eigen::VectorXd f;
    const double stored = model.forces(u, f).energy;
    double pushed = 0;
    for (int node = 0; node < model.mesh().nodes(); ++node) {
      if (model.mesh().X(2, node) < 1e-9) {
        EXPECT_NEAR(u(2, node), -compression, 1e-6 * d) << d;
      }
      if (model.mesh().X(2, node) > kHeight - 1e-9) pushed -= f[model.equation(node) + 2];
    }
    EXPECT_NEAR(pushed, kArea * kStiffness * compression, 1e-5 * pushed) << d;
    const double expected =
        kArea * (kHeight * energy(low) + 0.5 * kStiffness * compression * compression);
    EXPECT_NEAR(stored, expected, 1e-5 * expected) << d;
  }
}

/// At small strain, where the sides of the column bear no load.
TEST(Foundation, HasTangentialSpringsInSeriesWithAShearedColumn) {
  constexpr double kHeight = 0.04, kStiffness = 8e4, kShift = 1e-5;
  const double mu = 10e3 / 2.6;
  const SolidModel model(sprung_column(kHeight, 0, kStiffness),
                         {NeoHookean::from_young_poisson(10e3, 0.3, "t")});
  Displacement u = Displacement::Zero(3, model.mesh().nodes());
  test::equilibrate(model, test::Loads::Zero(3, model.mesh().nodes()), moved_top(model, 0, kShift),
                    u);
  const double expected = kShift * (mu / kHeight) / (mu / kHeight + kStiffness);
  for (int node = 0; node < model.mesh().nodes(); ++node) {
    if (model.mesh().X(2, node) > 1e-9) continue;
    EXPECT_NEAR(u(0, node), expected, 1e-4 * kShift);
  }
}

}  // namespace
}  // namespace palpate::fem
