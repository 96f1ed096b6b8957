// SPDX-License-Identifier: AGPL-3.0-or-later
// A search for what the certificate forbids must come near its bounds, and find what exceeds them.
#include "fitting/certificate/challenge.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "fitting/fitting.hpp"
#include "format/error.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

Library certified_sphere() {
  std::mt19937 engine(51);
  Library library = sphere(0.04, 2);
  for (std::size_t v = 0; v < library.positions.size(); ++v)
    library.responses.push_back(random_response(engine, 0.1));
  certify(library, {});
  return library;
}

TEST(Challenge, ComesNearTheBoundsAndNotBeyond) {
  const ChallengeResult result = challenge(certified_sphere(), {});
  std::printf("held %.3f, sliding %.3f of the bounds of the library\n",
              result.held.quotient / result.held.bound,
              result.sliding.quotient / result.sliding.bound);
  EXPECT_TRUE(result.stands());
  EXPECT_GT(result.held.quotient, 0.95 * result.held.bound);
  EXPECT_GT(result.sliding.quotient, 0.5 * result.sliding.bound);  // within a factor of two
  EXPECT_GT(result.sliding.tries, 10000);
}

TEST(Challenge, OfEqualSpringsIsTheirStiffness) {
  // Level springs k: held k in every direction along n, sliding sqrt(1 + mu^2) k.
  constexpr double k = 150, r = 150, mu = 0.3;
  Library library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(k), linear_curve(r)));
  CertifySettings settings;
  settings.friction = mu;
  certify(library, settings);
  const ChallengeResult result = challenge(library, {});
  EXPECT_NEAR(result.held.quotient, k, 1e-3 * k);
  EXPECT_NEAR(result.sliding.quotient, std::hypot(1.0, mu) * k, 1e-3 * k);
}

TEST(Challenge, FindsACertificateThatPromisesTooMuch) {
  Library library = certified_sphere();
  for (auto& triangle : library.certificate.triangles) triangle.slip *= 0.4, triangle.stick *= 0.4;
  EXPECT_FALSE(challenge(library, {}).stands());
}

TEST(Challenge, FindsOneTriangleThatPromisesTooMuch) {
  Library library = certified_sphere();
  library.certificate.triangles[100].stick *= 0.8;
  EXPECT_FALSE(challenge(library, {}).stands());
}

TEST(Challenge, NeedsACertificate) {
  Library library = certified_sphere();
  library.certificate = {};
  EXPECT_THROW(challenge(library, {}), Error);
}

}  // namespace
}  // namespace palpate::fitting
