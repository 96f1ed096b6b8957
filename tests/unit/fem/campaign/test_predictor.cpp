// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/predictor.hpp"

#include <gtest/gtest.h>

#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

class Prediction : public testing::Test {
 protected:
  Body body =
      test::make_block(test::even(0, 0.01, 2), test::even(0, 0.01, 2), test::even(0, 0.01, 2));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.45, "t")}};
  /// Uniform compression of the block by a fraction.
  Displacement compressed(double fraction) const { return -fraction * model.mesh().X; }
};

TEST_F(Prediction, OfOneStateIsThatState) {
  Predictor predictor;
  predictor.add(0, compressed(0.1));
  EXPECT_EQ(predictor.predict(model, 1), compressed(0.1));
}

TEST_F(Prediction, OfFourStatesIsExactForCubicPolynomials) {
  const auto u = [&](double s) { return compressed(0.01 * s + 0.02 * s * s - 0.015 * s * s * s); };
  Predictor predictor;
  for (const double s : {-1.0, 0.0, 0.2, 0.5, 0.9}) predictor.add(s, u(s));
  EXPECT_LT((predictor.predict(model, 1.1) - u(1.1)).norm(), 1e-12 * u(1.1).norm());
}

/// Linear extrapolation would leave 10 % of each length, and det F = 0.001.
TEST_F(Prediction, DoesNotInvertElements) {
  Predictor predictor;
  predictor.add(0, compressed(0));
  predictor.add(1, compressed(0.3));
  EXPECT_EQ(predictor.predict(model, 3), compressed(0.3));
  EXPECT_LT((predictor.predict(model, 1.05) - compressed(0.315)).norm(), 1e-12);
}

}  // namespace
}  // namespace palpate::fem
