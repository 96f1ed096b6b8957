// SPDX-License-Identifier: AGPL-3.0-or-later
// The functions of eight numbers at once against those of the C library.
#include "fem/laws/scalar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate::fem {
namespace {

/// The numbers of the laws: volume ratios, squares of stretches, exponents of fibres.
const Lanes kNumbers = (Lanes() << 1e-3, 0.2, 0.9, 1 - 1e-9, 1.0, 1 + 1e-9, 1.7, 40).finished();

template <class Eight, class One>
void expect_same(Eight eight, One one, double tolerance) {
  const Lanes result = eight(kNumbers);
  for (int lane = 0; lane < kLanes; ++lane) {
    const double expected = one(kNumbers[lane]);
    EXPECT_NEAR(result[lane], expected, tolerance * std::max(std::abs(expected), 1e-300))
        << kNumbers[lane];
  }
}

TEST(ScalarFunctions, AreThoseOfTheCLibraryInEveryLane) {
  expect_same([](const Lanes& x) { return logarithm(x); }, [](double x) { return std::log(x); },
              1e-15);
  expect_same([](const Lanes& x) { return exponential(x); }, [](double x) { return std::exp(x); },
              1e-15);
  // Eigen's eight square roots at once come from an estimate and Newton's method: the last bit.
  expect_same([](const Lanes& x) { return square_root(x); }, [](double x) { return std::sqrt(x); },
              2.3e-16);
}

double isochoric_scale_of(double J) {
  return std::pow(J, -2.0 / 3.0);
}

TEST(ScalarFunctions, TheIsochoricScaleIsThePowerOfAnyVolumeRatio) {
  const auto in_lanes = [](const Lanes& J) { return isochoric_scale(J); };
  expect_same(in_lanes, isochoric_scale_of, 4e-15);
  for (int i = 0; i <= 3000; ++i) {  // near 1, where they are found without a logarithm
    const double J = 0.5 + 1.5 * i / 3000;
    EXPECT_NEAR(isochoric_scale(Lanes(Lanes::Constant(J)))[kLanes - 1], isochoric_scale_of(J),
                1e-15 * isochoric_scale_of(J))
        << J;
  }
}

TEST(ScalarFunctions, TheIsochoricScaleOfOneLaneLeavesTheOthersAlone) {
  Lanes J = Lanes::Constant(1.1);
  J[2] = 1e-6;
  J[5] = std::numeric_limits<double>::quiet_NaN();
  const Lanes scale = isochoric_scale(J);
  EXPECT_NEAR(scale[0], isochoric_scale_of(1.1), 1e-15);
  EXPECT_NEAR(scale[2], 1e4, 1e-10);
  EXPECT_TRUE(std::isnan(scale[5]));
}

TEST(ScalarFunctions, ExceedsIsStrict) {
  expect_same([](const Lanes& x) { return exceeds(x, 1.0); },
              [](double x) { return x > 1 ? 1.0 : 0.0; }, 0);
  EXPECT_EQ(exceeds(1.0, 1.0), 0);
  EXPECT_EQ(exceeds(std::nextafter(1.0, 2.0), 1.0), 1);
}

TEST(ScalarFunctions, ConstantsFillEveryLane) {
  EXPECT_TRUE((constant_of<Lanes>(2.5) == 2.5).all());
  EXPECT_TRUE((zero_of<Lanes>() == 0).all());
  EXPECT_EQ(constant_of<double>(2.5), 2.5);
}

}  // namespace
}  // namespace palpate::fem
