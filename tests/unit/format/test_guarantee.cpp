// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/guarantee.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/numbers.hpp"

namespace palpate {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A certificate of two triangles, the second without bounds of its own.
Certificate certificate(double stick, double slip, double min_bound = kUnknown) {
  Certificate c;
  c.stick = stick;
  c.slip = slip;
  c.min_lipschitz_bound = min_bound;
  c.triangles.resize(2);
  c.triangles[0].slip = slip;
  return c;
}

TEST(LipschitzBoundText, IsRoundedUpToAValidSetting) {
  EXPECT_EQ(lipschitz_bound_text(104.41), "104.5 N/m");
  EXPECT_EQ(lipschitz_bound_text(104.5), "104.5 N/m");
  EXPECT_EQ(lipschitz_bound_text(1.23421), "1.235 N/m");
}

TEST(Guarantee, IsByTheCurvesWhereTheyKeepTheBound) {
  const Certificate c = certificate(100, 201.38, 186);
  EXPECT_EQ(guaranteed_by(c), GuaranteedBy::Curves);
  EXPECT_EQ(guarantee_text(c),
            "guaranteed by the curves themselves: the force changes by at most 201.4 N/m times the "
            "travel of the tool");
  EXPECT_EQ(verdict(c, {"pen", 0.081, 4972.3, 0, 0}),
            "passive from 4973 Hz on, by the curves themselves; from 4593 Hz on with "
            "lipschitz_bound = 186.0 N/m");
  EXPECT_EQ(verdict(certificate(100, 400), {"pen", 0.1, 8000, 0, 0}),
            "passive from 8000 Hz on, by the curves themselves");
}

TEST(Guarantee, IsByTheLimiterWhereTheCurvesHaveNoBound) {
  const Certificate c = certificate(100, kInfinity, 120);
  EXPECT_EQ(guaranteed_by(c), GuaranteedBy::Limiter);
  EXPECT_THAT(guarantee_text(c),
              StartsWith("guaranteed by the runtime, which throttles slides: the force changes by "
                         "at most 400.0 N/m"));
  EXPECT_THAT(guarantee_text(c), HasSubstr("no bound while sliding in 1 of 2 triangles"));
  EXPECT_THAT(verdict(c, {"pen", 0.1, 8000, 0, 0}),
              StartsWith("passive from 8000 Hz on, with slides throttled"));
}

TEST(Guarantee, StatesByHowMuchTheCurvesExceedTheLimiter) {
  const Certificate c = certificate(100, 900, 120);  // enforced: four times L_stick
  EXPECT_EQ(guaranteed_by(c), GuaranteedBy::Limiter);
  EXPECT_THAT(guarantee_text(c), HasSubstr("the curves alone reach 900.0 N/m"));
}

/// Nothing that reads as a promise stands where there is none.
TEST(Guarantee, IsNothingWithoutABound) {
  for (const Certificate& c :
       {Certificate{}, certificate(100, kInfinity), certificate(100, kInfinity, kInfinity)}) {
    EXPECT_EQ(guaranteed_by(c), GuaranteedBy::Nothing);
    EXPECT_THAT(guarantee_text(c), StartsWith("nothing is guaranteed"));
    EXPECT_EQ(verdict(c, {"pen", 0.1, kInfinity, 0, 0}),
              "no guarantee at any rate: slides have no bound");
  }
  EXPECT_EQ(verdict(certificate(100, 200), {"pen", kUnknown, kUnknown, kUnknown, kUnknown}),
            "no guarantee: its damping is unknown");
}

}  // namespace
}  // namespace palpate
