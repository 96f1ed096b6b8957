// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/slide_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fitting/certificate/certify.hpp"
#include "fitting/certificate/slide_bound.hpp"
#include "tests/unit/fitting/certificate/plain_model.hpp"

namespace palpate::fitting {
namespace {

TEST(SlideSearch, BoundsSlidesThatTheClosedFormDoesNot) {
  std::mt19937 engine(49);
  SlideCensus census;
  int gained = 0, unbounded = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Library library = random_triangle(engine, 0.22, 0.1);
    if (trial % 2 == 1) couple(library, engine, 0.1);
    CertifySettings settings;
    settings.friction = 0.3;
    certify(library, settings);
    const double depth = library.certificate.depth;
    if (std::isfinite(slide_bound(contact_element(library, 0, depth, settings.friction)).total))
      continue;
    ++unbounded;
    if (std::isinf(library.certificate.slip)) continue;
    ++gained;
    try_slides(engine, library, settings.friction, census);
  }
  EXPECT_GT(gained, 5);
  EXPECT_GE(unbounded, gained);
  EXPECT_GT(census.slides, 1000);
}

TEST(SlideSearch, EnclosesTheLargestForceGradientEverMoreClosely) {
  // Properties at every stage: the bound falls, the attained norm rises, and the bound exceeds it.
  std::mt19937 engine(51);
  for (int trial = 0; trial < 4; ++trial) {
    const Library library = random_triangle(engine, 0.06, 0.2);
    const ContactElement element = contact_element(library, 0, 0.008, 0.3);
    SlideSearch search(element);
    double bound = search.bound(), attained = 0;
    for (int i = 0; i < 8; ++i) {
      search.advance(100, 0);
      EXPECT_LE(search.bound(), bound);
      EXPECT_GE(search.attained(), attained);
      EXPECT_GE(search.bound(), search.attained());
      bound = search.bound();
      attained = search.attained();
    }
    EXPECT_LE(search.spent(), 800);
    EXPECT_GT(attained, 0);
    // No closed form of the same slides is below a norm that a slide attains.
    EXPECT_GE(slide_bound(element).total, attained * (1 - 1e-9));
  }
}

}  // namespace
}  // namespace palpate::fitting
