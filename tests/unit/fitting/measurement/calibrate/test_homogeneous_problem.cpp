// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fitting/measurement/calibrate/homogeneous_problem.hpp"
#include "tests/unit/fitting/measurement/calibrate/typical_constants.hpp"

namespace palpate::calibrate {
namespace {

std::vector<HomogeneousTest> two_tests() {
  HomogeneousTest pull{"pull", Mode::Uniaxial, {1.1, 1.2, 1.4}, {300, 500, 800}, {}, 1};
  HomogeneousTest shear{"shear", Mode::SimpleShear, {0.1, 0.3, 0.5, 0.7, 0.9}, {}, {}, 2};
  for (const double s : shear.deformation) shear.nominal.push_back(1000 * s);
  shear.offset = true;
  return {pull, shear};
}

/// The Jacobian by differences, in the law's constants and in the offset.
TEST(HomogeneousProblem, HasTheSlopesOfItsResiduals) {
  const auto tests = two_tests();
  for (const auto name : homogeneous_laws()) {
    HomogeneousSettings settings;
    settings.law = name;
    const auto squares = problem_of(tests, settings, IncompressibleLaw(name), false).squares;
    std::vector<double> c = typical(name);
    c.push_back(20);
    const std::size_t n = c.size();
    ASSERT_EQ(squares.constants.size(), n);
    ASSERT_EQ(squares.constants.back().name, "offset of shear");
    std::vector<double> r(8), J(8 * n), above(8), below(8);
    ASSERT_TRUE(squares.model(c.data(), r.data(), J.data()));
    for (std::size_t k = 0; k < n; ++k) {
      const double h = 1e-4 * std::abs(c[k]), at = c[k];
      c[k] = at + h;
      squares.model(c.data(), above.data(), nullptr);
      c[k] = at - h;
      squares.model(c.data(), below.data(), nullptr);
      c[k] = at;
      for (std::size_t row = 0; row < 8; ++row)
        EXPECT_NEAR(J[row * n + k], (above[row] - below[row]) / (2 * h),
                    1e-5 * std::abs(J[row * n + k]) + 1e-8)
            << name << row << k;
    }
  }
}

/// Under equal weights the squares of the stresses of the tests are as their weights squared, and
/// the deviations say what part of the weights is no noise.
TEST(HomogeneousProblem, WeighsTestsAlike) {
  const auto tests = two_tests();
  HomogeneousSettings settings;
  settings.law = "neo-hookean";
  const auto problem = problem_of(tests, settings, IncompressibleLaw("neo-hookean"), false);
  double pull = 0, shear = 0;
  for (const WeightedSample& s : problem.samples)
    (s.test == 0 ? pull : shear) += std::pow(s.factor * s.stress, 2);
  EXPECT_NEAR(shear / pull, 4, 1e-12);  // a weight of two
  EXPECT_NEAR(problem.squares.deviations[7] / problem.squares.deviations[0], 2 * std::sqrt(3.0 / 5),
              1e-12);
}

}  // namespace
}  // namespace palpate::calibrate
