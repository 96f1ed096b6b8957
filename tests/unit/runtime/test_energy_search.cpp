// SPDX-License-Identifier: AGPL-3.0-or-later
// An optimiser that looks for a cycle of motion which returns energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "tests/unit/runtime/adversary.hpp"

namespace palpate::test {
namespace {

using runtime::ContactSettings;
using runtime::EnergyBudget;

/// A closed path that presses, slides and leaves, in the terms of the surface: where it enters, the
/// two ways it goes on from there, how deep, and how fast.
struct Cycle {
  Vec3 entry{};
  std::array<Vec3, 2> way{};      ///< m, from the entry to the next places along the surface
  std::array<double, 3> depth{};  ///< m, at the three places
  std::array<int, 5> steps{};     ///< in, along, along, out, back
};

Cycle random_cycle(const Library& library, Random& random) {
  Cycle cycle;
  cycle.entry = near_surface(library, random, 0);
  for (Vec3& way : cycle.way) way = between(random, 0, 0.015) * random_unit(random);
  for (double& depth : cycle.depth) depth = between(random, 0.001, 0.008);
  for (int& steps : cycle.steps) steps = 10 + static_cast<int>(random() % 100);
  return cycle;
}

Cycle mutate(const Cycle& parent, double size, Random& random) {
  Cycle child = parent;
  child.entry = child.entry + size * random_unit(random);
  for (Vec3& way : child.way) way = way + size * random_unit(random);
  for (double& depth : child.depth) {
    depth = std::clamp(depth + between(random, -1, 1) * size / 2, 0.0, 0.009);
  }
  if (random() % 3 == 0) child.steps[random() % 5] = 2 + static_cast<int>(random() % 150);
  return child;
}

void go(WatchedContact& contact, const Vec3& a, const Vec3& b, int steps) {
  for (int i = 1; i <= steps; ++i) contact.step(a + (static_cast<double>(i) / steps) * (b - a));
}

void play(WatchedContact& contact, const palpate_library& body, const Cycle& cycle) {
  constexpr double kClearance = 0.001;
  const auto at = [&](const Vec3& place, double depth) {
    const runtime::SurfacePoint p = body.tree.nearest(place, 1);
    return body.surface.position(p) + depth * body.surface.normal(p);
  };
  const Vec3 second = cycle.entry + cycle.way[0];
  const Vec3 third = second + cycle.way[1];
  const std::array<Vec3, 5> stop{at(cycle.entry, cycle.depth[0]), at(second, cycle.depth[1]),
                                 at(third, cycle.depth[2]), at(third, -kClearance),
                                 at(cycle.entry, -kClearance)};
  contact.step(stop[4]);
  for (std::size_t k = 0; k < 5; ++k) go(contact, stop[(k + 4) % 5], stop[k], cycle.steps[k]);
}

struct Bargain {
  double returned = 0;  ///< J, by the best cycle, repeated
  long steps = 0;       ///< of all tries
};

/// An evolution strategy (1 + 6, success rule for the size of the mutations) that looks for the
/// cycle which returns most energy when it is repeated. `look` sees every try.
Bargain search_for_energy(const Library& library, const palpate_library& body,
                          const ContactSettings& settings, int generations,
                          const std::function<void(const WatchedContact&)>& look) {
  constexpr int kRepeats = 4;
  Random random(38);
  Bargain bargain;
  const auto returned = [&](const Cycle& cycle) {
    WatchedContact contact(library, body, settings);
    for (int r = 0; r < kRepeats; ++r) play(contact, body, cycle);
    look(contact);
    bargain.steps += contact.steps;
    return contact.contacts == 0 ? -1 : -contact.work();
  };
  Cycle best = random_cycle(library, random);
  bargain.returned = returned(best);
  double size = 0.004;
  for (int g = 0; g < generations; ++g) {
    bool better = false;
    for (int k = 0; k < 6; ++k) {
      const bool anew = g < generations / 4;
      const Cycle child = anew ? random_cycle(library, random) : mutate(best, size, random);
      const double gain = returned(child);
      if (gain <= bargain.returned) continue;
      bargain.returned = gain;
      best = child;
      better = true;
    }
    size = std::clamp(better ? 1.3 * size : 0.9 * size, 1e-5, 0.01);
  }
  return bargain;
}

using EnergySearch = CertifiedBody;

TEST_P(EnergySearch, FindsNoCycleThatReturnsEnergy) {
  const Bargain bargain = search_for_energy(library_, body_, settings(body_.lipschitz_bound), 120,
                                            [&](const WatchedContact& contact) {
                                              expect_sound(contact);
                                              expect_no_jump(contact);
                                            });
  EXPECT_LE(bargain.returned, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Bodies, EnergySearch, adversary_cases(), case_name);

/// The same search on the rule of the paper alone.
Bargain search_uncorrected(const char* name, double friction) {
  const Library library = certified(body_named(name), friction);
  const palpate_library body(library);
  return search_for_energy(library, body, {friction, 5e-3, EnergyBudget::Ignored}, 120,
                           [](const WatchedContact&) {});
}

TEST(UncorrectedRule, IsDetectedByTheSameOptimiser) {
  for (const char* name : {"cylinder", "hills", "cube", "thin"}) {
    for (const double friction : {0.0, 0.05}) {
      const double returned = search_uncorrected(name, friction).returned;
      EXPECT_GT(returned, 1e-6) << name << ", mu = " << friction;
    }
  }
}

}  // namespace
}  // namespace palpate::test
