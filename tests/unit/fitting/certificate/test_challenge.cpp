// SPDX-License-Identifier: AGPL-3.0-or-later
// A search for what the certificate forbids must come near its bounds, and find what exceeds them.
#include "fitting/certificate/challenge.hpp"

#include <gtest/gtest.h>

#include <random>

#include "fitting/certificate/certify.hpp"
#include "format/error.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/support/units.hpp"
#include "tests/unit/fitting/certificate/plain_model.hpp"

namespace palpate::fitting {
namespace {

Library certified_sphere(unsigned seed = 51) {
  std::mt19937 engine(seed);
  Library library = sphere(0.04, 1);
  for (std::size_t v = 0; v < library.positions.size(); ++v)
    library.responses.push_back(random_response(engine, 0.1));
  certify(library, {});
  return library;
}

/// Whatever the responses and whatever the search draws.
class ChallengeOfStreams : public testing::TestWithParam<unsigned> {};

TEST_P(ChallengeOfStreams, ApproachesTheBoundsAndDoesNotExceedThem) {
  ChallengeSettings settings;
  settings.seed = 100 + GetParam();
  const ChallengeResult result = challenge(certified_sphere(GetParam()), settings);
  EXPECT_TRUE(result.confirms());
  EXPECT_GT(result.sticking.quotient, 0.95 * result.sticking.bound);
  EXPECT_GT(result.sliding.quotient, 0.5 * result.sliding.bound);  // within a factor of two
  EXPECT_GT(result.sliding.tries, 10000);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ChallengeOfStreams, testing::Values(51U, 52U, 53U));

TEST(Challenge, ApproachesTheBoundsOfResponsesWithSoftAxes) {
  std::mt19937 engine(54);
  Library library = sphere(0.04, 1);
  for (std::size_t v = 0; v < library.positions.size(); ++v)
    library.responses.push_back(random_response(engine, 0.1));
  couple(library, engine, 0.1);
  soften(library, engine, 0.4);
  certify(library, {});
  const ChallengeResult result = challenge(library, {});
  EXPECT_TRUE(result.confirms());
  EXPECT_GT(result.sticking.quotient, 0.7 * result.sticking.bound);
  EXPECT_GT(result.sliding.quotient, 0.5 * result.sliding.bound);
  EXPECT_GT(result.sliding.tries, 10000);
}

TEST(Challenge, FindsTheStiffnessOfEqualSprings) {
  // Equal springs k: k at a fixed contact point, and while sliding sqrt(1 + mu^2) k.
  constexpr double k = 150, r = 150, mu = 0.3;
  Library library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(k), linear_curve(r)));
  CertifySettings settings;
  settings.friction = mu;
  certify(library, settings);
  const ChallengeResult result = challenge(library, {});
  EXPECT_NEAR(result.sticking.quotient, k, 1e-3 * k);
  EXPECT_NEAR(result.sliding.quotient, std::hypot(1.0, mu) * k, 1e-3 * k);
}

TEST(Challenge, RefutesBoundsThatAreTooSmall) {
  Library library = certified_sphere();
  for (auto& triangle : library.certificate.triangles) triangle.slip *= 0.4, triangle.stick *= 0.4;
  EXPECT_FALSE(challenge(library, {}).confirms());
}

TEST(Challenge, RefutesOneBoundThatIsTooSmall) {
  Library library = certified_sphere();
  library.certificate.triangles[30].stick *= 0.8;
  EXPECT_FALSE(challenge(library, {}).confirms());
}

TEST(Challenge, NeedsACertificate) {
  Library library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(150), linear_curve(100)));
  EXPECT_THROW(challenge(library, {}), Error);
}

TEST(Challenge, FindsTheSameInOtherUnitsOfForce) {
  constexpr double kForce = 1.0 / 1024;  // the stiffest response is then below 1
  Library library = certified_sphere();
  Library other = test::in_units(library, {.force = kForce});
  certify(other, {});
  ChallengeSettings settings;
  settings.tries = 20, settings.climbs = 4;
  const ChallengeResult here = challenge(library, settings), there = challenge(other, settings);
  EXPECT_NEAR(there.sticking.quotient, kForce * here.sticking.quotient, 1e-9 * kForce);
  EXPECT_NEAR(there.sliding.quotient, kForce * here.sliding.quotient, 1e-9 * kForce);
  EXPECT_EQ(there.sliding.tries, here.sliding.tries);
}

}  // namespace
}  // namespace palpate::fitting
