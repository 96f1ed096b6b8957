// SPDX-License-Identifier: AGPL-3.0-or-later
// A session in other units: forces, energies and lengths are those of the session, in these units.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "runtime/contact_state.hpp"
#include "runtime/handles.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/support/units.hpp"

namespace palpate::test {
namespace {

constexpr Units kOther{1.0 / 32, 8, 4};
constexpr double kEnergy = kOther.force * kOther.length;

/// A body in one of two systems of units, with a tool.
class Rendered {
 public:
  Rendered(const Library& library, double friction, double bound, double tank_cap)
      : body_(library),
        contact_(body_.surface, body_.tree,
                 {friction, tank_cap, runtime::EnergyBudget::Enforced, bound}) {}
  const runtime::ContactObservation& step(const Vec3& x, double dt) {
    contact_.step(x, dt);
    return contact_.observation();
  }

 private:
  palpate_library body_;
  runtime::ContactState contact_;
};

/// Balls of 30 mm whose stiffness varies over the surface.
Library ball(const std::string& kind) {
  Library elastic = sphere(3, 0.03, [](const Vec3& x) {
    const double s = 1 + 0.3 * std::sin(160 * x[2] + 120 * x[1]) * std::cos(110 * x[0]);
    NodeResponse node = wall_response(170 * s, 120);
    const double bend = 0.8 * std::sin(230 * x[0] + 170 * x[1]);
    node.lateral = stiffening_curve(120 * (1 - bend), 120 * (1 + bend), 5, 0.002);
    return node;
  });
  if (kind == "decoupled") return elastic;
  if (kind == "coupled") return coupled(elastic);
  const std::vector<double> times{0.01, 0.1};
  return relaxing(kind == "relaxing" ? elastic : coupled(elastic), times, false);
}

class Dimensions : public ::testing::TestWithParam<const char*> {};

TEST_P(Dimensions, ASessionIsTheSameInOtherUnits) {
  const Library library = ball(GetParam());
  constexpr double kFriction = 0.3, kTank = 1e-5;
  const double unbounded = std::numeric_limits<double>::infinity();
  Rendered here(library, kFriction, unbounded, kTank);
  Rendered there(in_units(library, kOther), kFriction, unbounded, kTank * kEnergy);
  std::mt19937_64 random(31);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const auto random_unit = [&] {
    const Vec3 v{normal(random), normal(random), normal(random)};
    return (1 / norm(v)) * v;
  };
  Vec3 direction = random_unit(), turn = random_unit();
  double depth = -1e-3;
  int contacts = 0, slides = 0;
  for (int leg = 0; leg < 100; ++leg) {
    const double to = leg % 7 == 6 ? -1e-3 : 5e-4 + 2.5e-3 * uniform(random);
    for (int i = 0; i < 40; ++i) {
      depth += (to - depth) / (40 - i);
      direction = direction + 4e-3 * turn;
      direction = (1 / norm(direction)) * direction;
      const Vec3 x = (0.03 - depth) * direction;
      const double dt = 1e-4 + 5e-3 * uniform(random);
      const auto& a = here.step(x, dt);
      const auto& b = there.step(kOther.length * x, kOther.time * dt);
      contacts += (a.status & PALPATE_CONTACT) != 0 ? 1 : 0;
      slides += (a.status & PALPATE_SLIDING) != 0 ? 1 : 0;
      ASSERT_LE(norm((1 / kOther.force) * b.force - a.force), 1e-4) << leg << " " << i;
      ASSERT_LE(norm((1 / kOther.length) * b.contact_point - a.contact_point), 1e-6);
      ASSERT_NEAR(b.energy / kEnergy, a.energy, 1e-7);
      ASSERT_NEAR(b.tank / kEnergy, a.tank, 1e-8);
      ASSERT_NEAR(b.absorbed / kEnergy, a.absorbed, 1e-7);
      ASSERT_NEAR(b.dissipated / kEnergy, a.dissipated, 1e-7);
      ASSERT_NEAR(b.offset / kOther.length, a.offset, 1e-6);
    }
    turn = random_unit();
  }
  EXPECT_GT(contacts, 2000);
  EXPECT_GT(slides, 1000);
}

INSTANTIATE_TEST_SUITE_P(Responses, Dimensions,
                         ::testing::Values("decoupled", "coupled", "relaxing", "relaxing_coupled"));

}  // namespace
}  // namespace palpate::test
