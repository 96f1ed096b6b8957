// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/certified.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "fitting/certificate/certify.hpp"
#include "fitting/certificate/device_profile.hpp"
#include "format/error.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::app {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Without delay, and with steps of nothing.
fitting::DeviceProfile device_with(double damping) {
  return {.name = "a device",
          .damping = damping,
          .coulomb_friction = 0.01,
          .peak_force = kNan,
          .source = "",
          .delay = 0,
          .position_resolution = 0,
          .force_resolution = 0};
}

Library certified_plate() {
  Library library = test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
  fitting::certify(library, {0.3, {}});
  return library;
}

/// Text of the refusal; empty when the session is certified.
std::string refusal(const Library& library, const fitting::DeviceProfile& device, double rate,
                    double friction = 0.3) {
  try {
    require_certified(why_not_certified(library, "library.h5", device, rate, friction));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_THAT(error.remedy(), HasSubstr("--uncertified"));
    return error.what();
  }
  return "";
}

TEST(Certified, TheRateIsOneAndAHalfTimesTheSmallestBoundOverTheDamping) {
  const Library library = certified_plate();
  const double lowest = 1.5 * library.certificate.min_lipschitz_bound / 0.5;
  EXPECT_EQ(refusal(library, device_with(0.5), lowest * 1.001), "");
  EXPECT_THAT(refusal(library, device_with(0.5), lowest * 0.999), HasSubstr("is not certified"));
}

TEST(Certified, SlidesAreThrottledAsFarAsTheRateRequires) {
  Library library = test::plate(
      8, 0.08, [](const Vec3& x) { return test::wall_response(170 + 1500 * x[0], 120); });
  fitting::certify(library, {0.3, {}});
  const Certificate& c = library.certificate;
  ASSERT_LT(1.01 * c.min_lipschitz_bound, c.lipschitz_bound);
  const fitting::DeviceProfile device = device_with(0.5);
  EXPECT_DOUBLE_EQ(lipschitz_bound_for(library, device, 1.5 * c.lipschitz_bound / 0.5 + 1),
                   c.lipschitz_bound);
  const double between = 1.5 * 0.5 * (c.min_lipschitz_bound + c.lipschitz_bound) / 0.5;
  EXPECT_NEAR(lipschitz_bound_for(library, device, between),
              0.5 * (c.min_lipschitz_bound + c.lipschitz_bound), 1e-9);
  EXPECT_EQ(refusal(library, device, between), "");
  // Below the smallest enforceable bound nothing is certified, and throttling gains nothing.
  const double below = 1.5 * 0.99 * c.min_lipschitz_bound / 0.5;
  EXPECT_DOUBLE_EQ(lipschitz_bound_for(library, device, below), c.lipschitz_bound);
  EXPECT_THAT(refusal(library, device, below), HasSubstr("is not certified"));
  EXPECT_DOUBLE_EQ(lipschitz_bound_for(library, device_with(kNan), 1e5), c.lipschitz_bound);
  library.certificate.min_lipschitz_bound = library.certificate.slip =
      std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(library, device, 1e7), HasSubstr("no rate is certified"));
}

TEST(Certified, SlidesAreThrottledAsFarAsTheResolutionRequires) {
  Library library = test::plate(
      8, 0.08, [](const Vec3& x) { return test::wall_response(170 + 1500 * x[0], 120); });
  fitting::certify(library, {0.3, {}});
  const Certificate& c = library.certificate;
  const double between = 0.5 * (c.min_lipschitz_bound + c.lipschitz_bound);
  fitting::DeviceProfile device = device_with(0.5);
  device.position_resolution = 2 * device.coulomb_friction / (std::sqrt(3.0) * between);
  EXPECT_NEAR(lipschitz_bound_for(library, device, 1e6), between, 1e-9);
  EXPECT_EQ(refusal(library, device, 1e6), "");
  device.position_resolution *= between / (0.99 * c.min_lipschitz_bound);
  EXPECT_THAT(refusal(library, device, 1e6), HasSubstr("dry friction"));
}

TEST(Certified, ADelayCostsRate) {
  const Library library = certified_plate();
  fitting::DeviceProfile device = device_with(0.5);
  const double lowest = 1.5 * library.certificate.min_lipschitz_bound / 0.5;
  device.delay = 0.2 / lowest;
  EXPECT_THAT(refusal(library, device, lowest * 1.2), HasSubstr("is not certified"));
  EXPECT_EQ(refusal(library, device, lowest * 1.7), "");
  device.delay = 10 / lowest;
  EXPECT_THAT(refusal(library, device, 1e9), HasSubstr("make up for the delay"));
}

TEST(Certified, WithoutCertificateOrAnyConstantNothingIs) {
  Library bare = certified_plate();
  bare.certificate.triangles.clear();
  EXPECT_THAT(refusal(bare, device_with(0.5), 1e5), HasSubstr("no certificate"));
  EXPECT_THAT(refusal(certified_plate(), device_with(kNan), 1e5),
              HasSubstr("its damping is unknown"));
  fitting::DeviceProfile device = device_with(0.5);
  device.coulomb_friction = device.delay = kNan;
  EXPECT_THAT(refusal(certified_plate(), device, 1e5),
              HasSubstr("its delay and dry friction are unknown"));
}

TEST(Certified, FrictionAboveThatOfTheCertificateIsNot) {
  const Library library = certified_plate();
  EXPECT_EQ(refusal(library, device_with(0.5), 1e5, 0.1), "");
  EXPECT_THAT(refusal(library, device_with(0.5), 1e5, 0.31),
              HasSubstr("friction coefficient of 0.31, only up to 0.3"));
}

}  // namespace
}  // namespace palpate::app
