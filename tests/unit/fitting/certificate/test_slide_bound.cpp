// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounds in closed form and in other units; test_slide_bound_on_slides.cpp tries them on slides.
#include "fitting/certificate/slide_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fitting/certificate/certify.hpp"
#include "tests/support/units.hpp"
#include "tests/unit/fitting/certificate/plain_model.hpp"

namespace palpate::fitting {
namespace {

TEST(Bounds, AreStiffnessesInAnyUnits) {
  // Of every formula of the bounds only those whose dimensions agree pass this.
  std::mt19937 engine(35);
  constexpr double kForce = 1.0 / 64, kLength = 8, kDepth = 0.008;
  int bounded = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Library library = random_triangle(engine, 0.04, 0.1 + 0.1 * (trial % 3));
    if (trial % 2 == 1) couple(library, engine, 0.1);
    const Library other = test::in_units(library, {kForce, kLength});
    const double mu = 0.2 * (trial % 4);
    const ContactElement here = contact_element(library, 0, kDepth, mu);
    const ContactElement there = contact_element(other, 0, kLength * kDepth, mu);
    const auto expect_same = [&](double in_these, double in_others) {
      if (std::isinf(in_these)) {
        EXPECT_TRUE(std::isinf(in_others));
      } else {
        EXPECT_NEAR(in_others * (kLength / kForce), in_these, 1e-9 * in_these);
      }
    };
    expect_same(stick_bound(here), stick_bound(there));
    expect_same(min_lipschitz_bound(here), min_lipschitz_bound(there));
    EXPECT_EQ(slide_lowers_energy(here), slide_lowers_energy(there));
    const SlideBound a = slide_bound(here), b = slide_bound(there);
    expect_same(a.total, b.total);
    expect_same(a.causes.stiffness, b.causes.stiffness);
    expect_same(a.causes.variation, b.causes.variation);
    expect_same(a.causes.slant, b.causes.slant);
    expect_same(a.causes.curvature, b.causes.curvature);
    bounded += std::isfinite(a.total) ? 1 : 0;
    if (!(mu > 0)) continue;
    const Range azimuth{0.4, 0.5}, z{0.0031, 0.0033}, reach{0.0033, 0.006};
    const auto larger = [&](const Range& range) {
      return Range{kLength * range.low, kLength * range.high};
    };
    SlideCell cell, scaled;
    cell.azimuth = scaled.azimuth = azimuth;
    cell.z = z, cell.reach = reach, scaled.z = larger(z), scaled.reach = larger(reach);
    expect_same(SlideJacobian(here).bound(cell), SlideJacobian(there).bound(scaled));
  }
  EXPECT_GT(bounded, 30);
}

TEST(SlipBound, SlantedPlateHasAClosedForm) {
  // Equal springs k (normal) and r (lateral), all directions leaning by theta against the facet:
  // nothing changes along the surface, yet the contact point runs down the slope. With t along the
  // slope, q = n . tau = sin(theta) (tau downhill), p = cos(theta):
  //   f' = k (n + mu t)(n - q w) . x',  w = (r t - mu k n)/(r p - mu k q).
  constexpr double kTheta = 0.15;
  constexpr double k = 200;
  constexpr double r = 120;
  constexpr double mu = 0.4;
  Library library = flat_triangle();
  library.inward.assign(3, {std::sin(kTheta), 0, -std::cos(kTheta)});
  set_equal_responses(library, node_response(linear_curve(k), linear_curve(r)));
  CertifySettings settings;
  settings.friction = mu;
  certify(library, settings);

  const double q = std::sin(kTheta);
  const double scale = 1 / (r * std::cos(kTheta) - mu * k * q);
  const double along_n = 1 + q * mu * k * scale;
  const double along_t = -q * r * scale;
  const double steepest = k * std::hypot(1.0, mu) * std::hypot(along_n, along_t);

  const PlainModel model(library, 0);
  const Vec3 n = model.direction({0.003, 0.003, 0});
  const Vec3 t{std::cos(kTheta), 0, std::sin(kTheta)};
  const Start start{
      {0.003, 0.003, 0}, Vec3{0.003, 0.003, 0} + 0.004 * n + (mu * k * 0.004 / r) * t, 0};
  // The steepest direction, or its opposite, makes the contact point slide forward.
  const Vec3 step = -1e-7 * unit(along_n * n + along_t * t);
  const auto c = model.slid(start.x + step, start.c, 0, mu);
  ASSERT_TRUE(c);
  ASSERT_GT(norm(*c - start.c), 1e-9);
  const Vec3 difference =
      model.at(start.x + step, *c, 0).force - model.at(start.x, start.c, 0).force;
  EXPECT_NEAR(norm(difference) / norm(step), steepest, 1e-3 * steepest);
  EXPECT_GT(steepest, 1.05 * k * std::hypot(1.0, mu));  // steeper than the level plate
  EXPECT_GE(library.certificate.slip, steepest);
  // Slides aslant are a little steeper than down the slope; sets of states are halved to 1.1.
  const ContactElement element = contact_element(library, 0, library.certificate.depth, mu);
  std::mt19937 engine(29);
  double steepest_anywhere = steepest;
  for (int i = 0; i < 60; ++i) {
    const SlidingState state = random_slide(engine, model, element);
    steepest_anywhere =
        std::max(steepest_anywhere, steepest_step(engine, model, state.start, settings.friction));
  }
  EXPECT_LE(library.certificate.slip, 1.11 * steepest_anywhere);
}

}  // namespace
}  // namespace palpate::fitting
