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

/// A device whose constants are known, without steps or delay, with this certificate.
DeviceCertificate pen(double damping, double lipschitz_bound) {
  DeviceCertificate device{"pen", damping, 0, 0, 0, 0.01, 0, 0, 0, 0, 0};
  device.lowest_rate = lowest_rate(device.constants(), {lipschitz_bound, 0});
  device.published_rate = published_rate(damping, lipschitz_bound);
  return device;
}

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
  EXPECT_EQ(verdict(c, pen(0.081, 201.38)),
            "certified passive from 3730 Hz on, by the curves themselves; from 3445 Hz on with "
            "lipschitz_bound = 186.0 N/m (Mahvash & Hayward 2005, eq. 5: 4973 Hz)");
  EXPECT_EQ(verdict(certificate(100, 400), pen(0.1, 400)),
            "certified passive from 6000 Hz on, by the curves themselves (Mahvash & Hayward 2005, "
            "eq. 5: 8000 Hz)");
}

TEST(Guarantee, IsByTheLimiterWhereTheCurvesHaveNoBound) {
  const Certificate c = certificate(100, kInfinity, 120);
  EXPECT_EQ(guaranteed_by(c), GuaranteedBy::Limiter);
  EXPECT_THAT(
      guarantee_text(c),
      StartsWith("guaranteed by the runtime, which rate-limits slides: the force changes by "
                 "at most 400.0 N/m"));
  EXPECT_THAT(guarantee_text(c), HasSubstr("no bound while sliding in 1 of 2 triangles"));
  EXPECT_THAT(verdict(c, pen(0.1, 400)),
              StartsWith("certified passive from 6000 Hz on, with slides rate-limited"));
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
    EXPECT_EQ(verdict(c, pen(0.1, kInfinity)), "no guarantee at any rate: slides have no bound");
  }
  EXPECT_EQ(
      verdict(certificate(100, 200), {"pen", kUnknown, kUnknown, kUnknown, kUnknown}),
      "no guarantee: its damping, delay, dry friction, position resolution and force resolution "
      "are unknown");
}

TEST(Verdict, NamesWhatIsMissingAndCertifiesNothingWithout) {
  const Certificate c = certificate(100, 200, 120);
  DeviceCertificate device = pen(0.1, 200);
  EXPECT_TRUE(is_certified(c, device));
  device.position_resolution = device.force_resolution = kUnknown;
  EXPECT_FALSE(is_certified(c, device));
  EXPECT_EQ(verdict(c, device),
            "no guarantee: its position resolution and force resolution are unknown; its damping "
            "suffices from 3000 Hz on");
}

TEST(Verdict, CertifiesNoRateWhereDryFrictionDoesNotPayForTheResolution) {
  const Certificate c = certificate(100, 200, 120);
  DeviceCertificate device = pen(0.1, 200);
  device.position_resolution = 70e-6;  // 0.01 N pay for 58 um at 200 N/m and for 96 um at 120 N/m
  EXPECT_FALSE(is_certified(c, device));
  EXPECT_THAT(verdict(c, device), StartsWith("certified passive from 1800 Hz on with "
                                             "lipschitz_bound = 120.0 N/m"));
  device.position_resolution = 1e-4;
  EXPECT_EQ(verdict(c, device),
            "no guarantee at any rate: its dry friction allows positions in steps of 57.7 um, not "
            "of 100 um");
  device.position_resolution = 0;
  device.delay = 0.1 / 200;
  device.lowest_rate = lowest_rate(device.constants(), {200, 0});
  EXPECT_THAT(verdict(certificate(100, 200), device), HasSubstr("make up for its delay"));
}

TEST(CertifiedRange, OfFrictionEndsAtThatOfTheCertificate) {
  Library library;
  library.certificate = certificate(100, 200, 120);
  library.certificate.friction = 0.3;
  for (const ResponseKind kind : {ResponseKind::Coupled, ResponseKind::Decoupled}) {
    library.kind = kind;
    for (const double mu : {0.0, 0.1, 0.3}) EXPECT_TRUE(certified_range(library).covers(mu)) << mu;
    for (const double mu : {-0.1, 0.3001, 1.0, kUnknown})
      EXPECT_FALSE(certified_range(library).covers(mu)) << mu;
  }
  library.certificate.min_lipschitz_bound = kUnknown;  // schema 1
  EXPECT_FALSE(certified_range(library).covers(0.1));
  EXPECT_FALSE(certified_range({}).covers(0));
}

TEST(CertifiedRange, OfBoundsBeginsAtTheSmallestEnforceable) {
  Library library;
  library.certificate = certificate(100, 200, 120);
  EXPECT_TRUE(certified_range(library).enforces(120));
  EXPECT_FALSE(certified_range(library).enforces(119));
  EXPECT_FALSE(certified_range(library).enforces(kInfinity));
  library.certificate.min_lipschitz_bound = kUnknown;
  EXPECT_TRUE(certified_range(library).enforces(200));
  EXPECT_FALSE(certified_range(library).enforces(199));
  EXPECT_FALSE(certified_range({}).enforces(1e9));
}

}  // namespace
}  // namespace palpate
