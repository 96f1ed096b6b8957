// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/measurement/calibrate/scan.hpp"
#include "tests/unit/fitting/measurement/calibrate/typical_constants.hpp"

namespace palpate::calibrate {
namespace {

std::vector<WeightedSample> samples_of(std::string_view law, const std::vector<double>& c,
                                       double offset = 0) {
  std::vector<WeightedSample> samples;
  for (std::size_t m = 0; m < kModes.size(); ++m)
    for (int i = 1; i <= 10; ++i) {
      const double s = rest_of(kModes[m]) + 0.1 * i;
      samples.push_back(
          {kModes[m], s, law_stress(law, c, kModes[m], s) + (m == 0 ? offset : 0), 1 + 0.1 * i, m});
    }
  return samples;
}

double cost_of(std::string_view law, const std::vector<double>& c,
               const std::vector<WeightedSample>& samples) {
  double cost = 0;
  for (const WeightedSample& s : samples)
    cost += std::pow(s.factor * (law_stress(law, c, s.mode, s.deformation) - s.stress), 2);
  return cost;
}

/// No start is better than the first, and it leaves two hundredths of the stress at most.
TEST(Scan, StartsCloseToTheData) {
  for (const auto name : homogeneous_laws()) {
    const auto samples = samples_of(name, typical(name));
    const auto starts = scanned_starts(IncompressibleLaw(name), samples);
    ASSERT_FALSE(starts.empty()) << name;
    const double first = cost_of(name, starts[0], samples);
    for (const auto& start : starts) EXPECT_GE(cost_of(name, start, samples), first * (1 - 1e-4));
    double squares = 0;
    for (const WeightedSample& s : samples) squares += std::pow(s.factor * s.stress, 2);
    EXPECT_LT(first, 4e-4 * squares) << name;
  }
}

/// Laws that are linear in their constants have their solution as the only start, with an offset of
/// one test taken out as well.
TEST(Scan, SolvesLinearLaws) {
  for (const auto name : {"neo-hookean", "mooney-rivlin", "mooney-rivlin-5", "yeoh"}) {
    const auto c = typical(name);
    const auto starts = scanned_starts(IncompressibleLaw(name), samples_of(name, c, 0.3),
                                       {.offset = {true, false, false, false}});
    ASSERT_EQ(starts.size(), 1U) << name;
    for (std::size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(starts[0][i], c[i], 1e-9) << name;
  }
}

/// Moduli below zero only where they are asked for.
TEST(Scan, HasModuliOfEitherSignWhereAsked) {
  const auto samples = samples_of("ogden-2", {1.5, 3, -0.5, 1.2});
  const IncompressibleLaw law("ogden-2");
  for (const auto& start : scanned_starts(law, samples)) EXPECT_GE(std::min(start[0], start[2]), 0);
  const auto any = scanned_starts(law, samples, {.any_sign = true, .offset = {}});
  EXPECT_LT(std::min(any[0][0], any[0][2]), 0);
  EXPECT_LT(cost_of("ogden-2", any[0], samples),
            cost_of("ogden-2", scanned_starts(law, samples)[0], samples));
}

/// Two terms that are one leave the third alone; exchanging one of them finds what is missing.
TEST(Scan, ExchangesATermThatIsTwice) {
  const std::vector<double> truth{0.6, 1.3, 0.02, 5, 0.1, -2};
  const auto samples = samples_of("ogden-3", truth);
  const std::vector<double> twice{0.3, 1.3, 0.3, 1.3, 0.02, 5};
  const IncompressibleLaw law("ogden-3");
  double best = cost_of("ogden-3", twice, samples);
  EXPECT_GT(best, 1);
  for (const auto& start : exchanged_terms(law, samples, twice))
    best = std::min(best, cost_of("ogden-3", start, samples));
  EXPECT_LT(best, 1e-2);
  EXPECT_TRUE(exchanged_terms(IncompressibleLaw("yeoh"), samples, {1, 0, 0}).empty());
}

TEST(Scan, KnowsTheFirstInvariant) {
  EXPECT_NEAR(first_invariant(Mode::Uniaxial, 2), 4 + 2 * 0.5 - 3, 1e-12);
  EXPECT_NEAR(first_invariant(Mode::SimpleShear, 0.7), 0.49, 1e-12);
}

}  // namespace
}  // namespace palpate::calibrate
