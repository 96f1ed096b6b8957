// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/certified.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "fitting/certificate/certify.hpp"
#include "fitting/certificate/device_profile.hpp"
#include "format/error.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::app {
namespace {

fitting::DeviceProfile device_with(double damping) {
  fitting::DeviceProfile profile;
  profile.name = "a device";
  profile.damping = damping;
  return profile;
}

Library certified_plate() {
  Library library = test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
  fitting::certify(library, {0.3, {}});
  return library;
}

/// Text of the refusal; empty when the rate is accepted.
std::string refusal(const Library& library, double damping, double rate) {
  try {
    require_certified(library, "library.h5", device_with(damping), rate);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_NE(error.remedy().find("--uncertified"), std::string::npos);
    return error.what();
  }
  return "";
}

TEST(Certified, TheRateIsTwiceTheLipschitzBoundOverTheDamping) {
  const Library library = certified_plate();
  // On a plane L = max(L_stick, L_slip), both in the certificate; below 4 L_stick it is that.
  const double steepest = std::max(library.certificate.stick, library.certificate.slip);
  ASSERT_LT(steepest, 4 * library.certificate.stick);
  EXPECT_NEAR(certified_rate(library, device_with(0.5)), 2 * steepest / 0.5, 1e-9);
  const double needed = certified_rate(library, device_with(0.5));
  EXPECT_EQ(refusal(library, 0.5, needed * 1.001), "");
  // Between that and L_min slides are throttled.
  const double lowest = 2 * library.certificate.min_lipschitz_bound / 0.5;
  EXPECT_NE(refusal(library, 0.5, lowest * 0.999).find("is not certified"), std::string::npos);
}

TEST(Certified, SlidesAreThrottledAsFarAsTheRateRequires) {
  Library library = test::plate(
      8, 0.08, [](const Vec3& x) { return test::wall_response(170 + 1500 * x[0], 120); });
  fitting::certify(library, {0.3, {}});
  const Certificate& c = library.certificate;
  ASSERT_LT(1.01 * c.min_lipschitz_bound, c.lipschitz_bound);
  const fitting::DeviceProfile device = device_with(0.5);
  EXPECT_DOUBLE_EQ(lipschitz_bound_for(library, device, 2 * c.lipschitz_bound / 0.5 + 1),
                   c.lipschitz_bound);
  const double between = 2 * 0.5 * (c.min_lipschitz_bound + c.lipschitz_bound) / 0.5;
  EXPECT_NEAR(lipschitz_bound_for(library, device, between),
              0.5 * (c.min_lipschitz_bound + c.lipschitz_bound), 1e-9);
  EXPECT_EQ(refusal(library, 0.5, between), "");
  // Below the smallest enforceable bound nothing is certified, and throttling gains nothing.
  const double below = 2 * 0.99 * c.min_lipschitz_bound / 0.5;
  EXPECT_DOUBLE_EQ(lipschitz_bound_for(library, device, below), c.lipschitz_bound);
  EXPECT_NE(refusal(library, 0.5, below).find("is not certified"), std::string::npos);
  EXPECT_DOUBLE_EQ(lipschitz_bound_for(library, device_with(std::nan("")), 1e5), c.lipschitz_bound);
  library.certificate.min_lipschitz_bound = library.certificate.slip =
      std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(library, 0.5, 1e7).find("no rate is certified"), std::string::npos);
}

TEST(Certified, WithoutCertificateOrDampingNothingIs) {
  Library bare = certified_plate();
  bare.certificate.triangles.clear();
  EXPECT_NE(refusal(bare, 0.5, 1e5).find("no certificate"), std::string::npos);
  EXPECT_NE(refusal(certified_plate(), std::nan(""), 1e5).find("damping"), std::string::npos);
}

}  // namespace
}  // namespace palpate::app
