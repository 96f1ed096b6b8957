// SPDX-License-Identifier: AGPL-3.0-or-later
// Presses at and beyond the borders of a response surface, deeper than the samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/runtime/adversary.hpp"

namespace palpate::test {
namespace {

using runtime::EnergyBudget;

/// Vertices of the edges that belong to one triangle.
std::vector<std::size_t> border_vertices(const Library& library) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  for (const Triangle& t : library.triangles)
    for (std::size_t l = 0; l < 3; ++l) ++uses[std::minmax({t[l], t[(l + 1) % 3]})];
  std::vector<std::size_t> border;
  for (const auto& [edge, count] : uses)
    if (count == 1) border.push_back(static_cast<std::size_t>(edge.first));
  return border;
}

/// Presses at and beyond a border of the surface, up to four times as deep as the deepest sample,
/// and drags there.
void press_borders(WatchedContact& contact, const Library& library, Random& random, int steps) {
  const std::vector<std::size_t> rim = border_vertices(library);
  for (int i = 0; i < steps;) {
    const std::size_t v = rim[random() % rim.size()];
    const double deep = std::pow(4, between(random, -1, 1)) * library.certificate.depth;
    const Vec3 over = library.positions[v] + between(random, 0, 0.01) * random_unit(random);
    Vec3 x = over - 0.002 * library.inward[v];
    contact.step(x);
    for (int leg = 0; leg < 6; ++leg) {
      const double depth = leg == 5 ? -0.002 : between(random, 0, deep);
      const Vec3 to =
          over + depth * library.inward[v] + between(random, 0, 0.01) * random_unit(random);
      const int count = 1 + static_cast<int>(std::pow(10, between(random, 0, 2)));
      const Vec3 step = (1.0 / count) * (to - x);
      for (int k = 0; k < count && i < steps; ++k, ++i) contact.step(x = x + step);
    }
  }
}

class Borders : public ::testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(Borders, DeepPressesKeepTheBoundUpToTheFrictionOfTheCertificate) {
  const auto [name, friction] = GetParam();
  const Library library = certified(body_named(name), friction);
  const palpate_library body(library);
  for (const double mu : {friction, 0.5 * friction}) {
    if (!body.certified_range.covers(mu)) continue;
    for (const double bound : {body.lipschitz_bound, library.certificate.min_lipschitz_bound}) {
      Random random(7);
      WatchedContact contact(library, body, {mu, 5e-3, EnergyBudget::Enforced, bound});
      press_borders(contact, library, random, 60000);
      expect_sound(contact);
      expect_no_jump(contact);
      EXPECT_GT(contact.apart, 1000);
    }
  }
}

TEST(FrictionAboveTheCertificate, BreaksTheBoundAndIsNotCertified) {
  const Library library = certified(body_named("coupled_rims"), 0.3);
  const palpate_library body(library);
  constexpr double kMore = 10;  // a contact that shrinks loses up to ten times its normal force
  EXPECT_FALSE(body.certified_range.covers(kMore));
  EXPECT_TRUE(body.certified_range.covers(0.1));
  Random random(7);
  WatchedContact contact(
      library, body,
      {kMore, 5e-3, EnergyBudget::Enforced, library.certificate.min_lipschitz_bound});
  press_borders(contact, library, random, 60000);
  EXPECT_GT(contact.steepest_step, 1);
}

INSTANTIATE_TEST_SUITE_P(Rims, Borders,
                         ::testing::Values(std::pair{"cylinder", 0.1}, std::pair{"thin", 0.5},
                                           std::pair{"coupled_rims", 0.3},
                                           std::pair{"coupled_thin", 0.5}),
                         [](const auto& about) { return std::string(about.param.first); });

}  // namespace
}  // namespace palpate::test
