// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/soften.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

CertifySettings with_friction(double mu) {
  CertifySettings settings;
  settings.friction = mu;
  return settings;
}

TEST(Soften, BoundsAreProportionalToTheForces) {
  // Bounds are homogeneous: half the forces, half the bounds.
  std::mt19937 engine(7);
  Library library = sphere(0.04, 0);
  for (std::size_t v = 0; v < library.positions.size(); ++v)
    library.responses.push_back(random_response(engine, 0.1));
  Library half = library;
  for (NodeResponse& node : half.responses)
    for (ResponseCurve* curve : {&node.normal, &node.lateral})
      for (float& slope : curve->slope) slope *= 0.5F;
  certify(library, {});
  certify(half, {});
  ASSERT_TRUE(std::isfinite(library.certificate.slip));
  EXPECT_NEAR(half.certificate.stick, 0.5 * library.certificate.stick, 1e-6);
  EXPECT_NEAR(half.certificate.slip, 0.5 * library.certificate.slip,
              0.03 * library.certificate.slip);  // cells are halved to 2 %
}

TEST(Soften, MeetsTheBoundAndChangesOnlySteepSlopes) {
  Library library = flat_triangle();
  const ResponseCurve soft{{0.0F, 0.008F}, {0.0F, 60.0F}};
  const ResponseCurve stiff{{0.0F, 0.004F, 0.008F}, {0.0F, 60.0F, 400.0F}};
  library.responses = {node_response(soft, linear_curve(50)), node_response(soft, linear_curve(50)),
                       node_response(stiff, linear_curve(50))};
  CertifySettings settings;
  settings.friction = 0;
  Library same = library;
  EXPECT_EQ(soften(same, settings, 1e5).curves, 0u);
  EXPECT_EQ(same.responses[2].normal.slope, stiff.slope);

  const Softening cost = soften(library, settings, 150);
  EXPECT_LE(library.certificate.min_lipschitz_bound, 150);
  EXPECT_GE(library.certificate.min_lipschitz_bound, 145);  // no more than needed
  EXPECT_DOUBLE_EQ(library.certificate.lipschitz_bound, 150);
  EXPECT_EQ(cost.curves, 1u);
  EXPECT_EQ(library.responses[0].normal.slope, soft.slope);
  EXPECT_EQ(library.responses[2].normal.slope[1], 60.0F);
  EXPECT_EQ(library.responses[2].normal.slope[2], static_cast<float>(cost.max_slope));
  // f(8 mm) = 0.12 + 0.004 (60 + s)/2 N
  EXPECT_NEAR(cost.worst, 1 - (0.12 + 0.002 * (60 + cost.max_slope)) / (0.12 + 0.002 * 460), 1e-6);
}

TEST(Soften, ThrottlesSlidesBeforeItSoftens) {
  // The radius of curvature is below the depth: no softening gives a bound of the slide.
  Library library = sphere(0.005, 1);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  const Library before = library;
  EXPECT_EQ(soften(library, with_friction(0.3), 120).curves, 0u);
  EXPECT_TRUE(std::isinf(library.certificate.slip));
  EXPECT_DOUBLE_EQ(library.certificate.lipschitz_bound, 120);
  for (std::size_t v = 0; v < before.responses.size(); ++v)
    EXPECT_EQ(library.responses[v].normal.slope, before.responses[v].normal.slope);
  EXPECT_GT(soften(library, with_friction(0.3), 80).curves, 0u);
  EXPECT_LE(library.certificate.min_lipschitz_bound, 80);
  EXPECT_DOUBLE_EQ(library.certificate.lipschitz_bound, 80);
}

TEST(Soften, RefusesABoundBelowAHundredthOfTheSlopes) {
  Library library = sphere(0.005, 1);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  EXPECT_ANY_THROW(soften(library, {}, 0.5));
  EXPECT_EQ(library.responses[0].normal.slope[0], 100.0F);
}

}  // namespace
}  // namespace palpate::fitting
