// SPDX-License-Identifier: AGPL-3.0-or-later
// Millions of steps by those who want energy out of the body, a jump of force, or a number that is
// none. What holds for all of them is checked in every step by WatchedContact.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "format/numbers.hpp"
#include "runtime/search.hpp"
#include "tests/unit/runtime/adversary.hpp"

namespace palpate::test {
namespace {

using runtime::EnergyBudget;

/// Wanders while triangles are delivered and taken away at random: all, none, the ones nearby, or
/// some of them.
void starve(WatchedContact& contact, const Library& library, Random& random, int steps) {
  const palpate_library body(library);
  runtime::Search search(body.surface, body.tree, 24);
  runtime::Delivery delivered;
  std::vector<std::int32_t> some;
  Vec3 x = near_surface(library, random, 0.002);
  for (int i = 0; i < steps;) {
    const Vec3 goal = near_surface(library, random, between(random, -0.008, 0.004));
    const int count = 1 + static_cast<int>(random() % 300);
    const Vec3 step = (1.0 / count) * (goal - x);
    for (int k = 0; k < count && i < steps; ++k, ++i) {
      x = x + step;
      contact.step(x);
      if (i % 20 != 0) continue;
      const auto kind = random() % 8;
      if (kind > 0) delivered = search.look({x, contact.seen().point.element});
      some.assign(delivered.elements().begin(), delivered.elements().end());
      if (kind < 3) std::erase_if(some, [&](std::int32_t) { return random() % 2 == 0; });
      delivered.assign(some);
      contact.set_delivery(kind == 7 ? nullptr : &delivered);
    }
  }
  contact.set_delivery(nullptr);
}

using Mover = std::function<void(WatchedContact&, const Library&, Random&, int steps)>;

/// From place to place over the surface, in and out, at speeds from a crawl to several metres a
/// second at 1 kHz.
void wander(WatchedContact& contact, const Library& library, Random& random, int steps) {
  Vec3 x = near_surface(library, random, 0.002);
  for (int i = 0; i < steps;) {
    const Vec3 goal = near_surface(library, random, between(random, -0.008, 0.004));
    const int count = 1 + static_cast<int>(std::pow(10, between(random, 0.3, 2.8)));
    const Vec3 step = (1.0 / count) * (goal - x);
    for (int k = 0; k < count && i < steps; ++k, ++i) {
      x = x + step;
      contact.step(x);
    }
  }
}

/// Trembles about a place at the surface, by nanometres up to millimetres.
void tremble(WatchedContact& contact, const Library& library, Random& random, int steps) {
  for (int i = 0; i < steps;) {
    const Vec3 centre = near_surface(library, random, between(random, -0.004, 0.0005));
    const double size = std::pow(10, between(random, -9, -2.5));
    contact.step(near_surface(library, random, 0.001));
    for (int k = 0; k < 150 && i < steps; ++k, ++i) {
      contact.step(centre + size * random_unit(random));
    }
  }
}

/// Enters and then goes exactly along edges and from vertex to vertex.
void follow_edges(WatchedContact& contact, const Library& library, Random& random, int steps) {
  std::size_t m = random() % library.triangles.size();
  std::size_t l = 0;
  double depth = -0.001;
  const auto over = [&](std::size_t v, double d) {
    return library.positions[v] + d * library.inward[v];
  };
  for (int i = 0; i < steps;) {
    const auto from = static_cast<std::size_t>(library.triangles[m][l]);
    const auto to = static_cast<std::size_t>(library.triangles[m][(l + 1) % 3]);
    const double next = between(random, -0.001, 0.006);
    const int count = 1 + static_cast<int>(random() % 60);
    for (int k = 1; k <= count && i < steps; ++k, ++i) {
      const double s = static_cast<double>(k) / count;
      contact.step((1 - s) * over(from, depth) + s * over(to, next));
    }
    depth = next;
    // Any triangle that has the vertex we are at.
    for (std::size_t tries = 0; tries < library.triangles.size(); ++tries) {
      m = (m + 1 + random() % 7) % library.triangles.size();
      const Triangle& t = library.triangles[m];
      const auto at = std::find(t.begin(), t.end(), static_cast<std::int32_t>(to));
      if (at == t.end()) continue;
      l = static_cast<std::size_t>(at - t.begin());
      break;
    }
  }
}

/// Straight through the body, at up to 50 mm a step.
void pass_through(WatchedContact& contact, const Library& library, Random& random, int steps) {
  for (int i = 0; i < steps;) {
    const Vec3 a = near_surface(library, random, 0.03);
    const Vec3 b = near_surface(library, random, between(random, -0.02, 0.03));
    const int count = 2 + static_cast<int>(random() % 40);
    for (int k = 0; k <= count && i < steps; ++k, ++i) {
      contact.step(a + (static_cast<double>(k) / count) * (b - a));
    }
  }
}

/// Presses, and in between gives what is no position, or one out of this world.
void break_input(WatchedContact& contact, const Library& library, Random& random, int steps) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kHuge = std::numeric_limits<double>::max();
  const std::array<double, 8> odd{kNan,   kInfinity, -kInfinity, kHuge,
                                  -kHuge, 1e150,     5e-324,     std::nextafter(0.0, -1.0)};
  Vec3 x = near_surface(library, random, 0.001);
  for (int i = 0; i < steps; ++i) {
    if (i % 50 == 0) x = near_surface(library, random, between(random, 0, 0.002));
    x = x + 2e-4 * random_unit(random);
    Vec3 given = x;
    if (random() % 40 == 0) given[random() % 3] = odd[random() % odd.size()];
    if (random() % 90 == 0) given = x + between(random, 0, 2) * random_unit(random);
    contact.step(given);
  }
}

class Adversary : public CertifiedBody {
 protected:
  void run(const char* name, const Mover& mover, double lipschitz_bound) {
    constexpr int kSteps = 100000;
    SCOPED_TRACE(name);
    Random random(2005);
    WatchedContact contact(library_, body_, settings(lipschitz_bound));
    mover(contact, library_, random, kSteps);
    expect_sound(contact);
    expect_no_jump(contact);
    apart_ += contact.apart;
    dragged_ += contact.dragged;
    EXPECT_GT(contact.contacts, 35);
    EXPECT_GT(contact.slides, 5000);
    limited_ += contact.limited;
    force_limited_ += contact.force_limited;
  }

  void run_all(double lipschitz_bound) {
    run("wander", wander, lipschitz_bound);
    run("tremble", tremble, lipschitz_bound);
    run("follow_edges", follow_edges, lipschitz_bound);
    run("pass_through", pass_through, lipschitz_bound);
    run("break_input", break_input, lipschitz_bound);
    run("starve", starve, lipschitz_bound);
  }

  long limited_ = 0, force_limited_ = 0, apart_ = 0, dragged_ = 0;
};

TEST_P(Adversary, GetsNoEnergyNoJumpAndNoNonsense) {
  ASSERT_TRUE(std::isfinite(body_.lipschitz_bound));
  run_all(body_.lipschitz_bound);
  // The limits did act. (On a plane without friction a slide is exact and its force changes by less
  // than the limit allows.)
  EXPECT_GT(limited_, 0);
  if (GetParam().friction > 0) {
    EXPECT_GT(force_limited_, 0);
  }
  EXPECT_GT(apart_, 1000);
  if (library_.relaxes() && library_.kind == ResponseKind::Decoupled) {
    EXPECT_GT(dragged_, 10000);
  }
}

TEST_P(Adversary, GetsNoneOfThemAtTheSmallestEnforceableBound) {
  const double min_bound = library_.certificate.min_lipschitz_bound;
  ASSERT_GE(min_bound, library_.certificate.stick);
  ASSERT_LE(min_bound, body_.lipschitz_bound);
  run_all(min_bound);
}

INSTANTIATE_TEST_SUITE_P(Bodies, Adversary, adversary_cases(), case_name);

TEST(UncorrectedRule, IsDetectedByTheSameChecks) {
  // Without a cycle: the checks detect a gain at the activation itself.
  const Library library = certified(body_named("cylinder"), 0.1);
  const palpate_library body(library);
  Random random(2005);
  WatchedContact contact(library, body, {0.1, 0, EnergyBudget::Ignored});
  wander(contact, library, random, 20000);
  EXPECT_GT(contact.largest_gain, 1e-6);
  EXPECT_GT(contact.steepest_step, 1);  // and the force jumps where the slide is cut into samples
  EXPECT_GT(contact.largest_overdraft, 1);
}

}  // namespace
}  // namespace palpate::test
