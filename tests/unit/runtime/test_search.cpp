// SPDX-License-Identifier: AGPL-3.0-or-later
// The search at a low rate: its deliveries, and forces equal to those of the search in the step.
#include "runtime/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "runtime/handles.hpp"
#include "runtime/lockstep_search.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::ContactSettings;
using runtime::ContactState;
using runtime::Delivery;
using runtime::kNoElement;
using runtime::LockstepSearch;
using runtime::Search;

const ContactSettings kSettings{0.2, 5e-3};

Responses varied() {
  return [](const Vec3& x) {
    const double s = 1 + 0.4 * std::sin(160 * x[2]);
    return wall_response(170 * s, 120 * s);
  };
}

/// The cylinder of the paper: about 500 patches of 10 mm.
const palpate_library& patches() {
  static const palpate_library body(cylinder(25, 20, 0.04, 0.2, varied()));
  return body;
}

Vec3 on_cylinder(double angle, double r, double z) {
  return {r * std::cos(angle), r * std::sin(angle), z};
}

std::set<std::int32_t> ring_by_definition(const runtime::Surface& surface, std::int32_t active) {
  std::set<std::int32_t> ring;
  const auto& mine = surface.element(active).vertices;
  for (std::int32_t m = 0; m < surface.element_count(); ++m) {
    const auto& theirs = surface.element(m).vertices;
    const bool shares = std::any_of(theirs.begin(), theirs.end(), [&](std::int32_t v) {
      return std::find(mine.begin(), mine.end(), v) != mine.end();
    });
    if (shares && surface.element(m).active) ring.insert(m);
  }
  return ring;
}

TEST(Search, DeliversTheRingOfTheActiveElementFirst) {
  const palpate_library body(bumpy_sphere(3, 0.03, 0.2, varied()));
  Search search(body.surface, body.tree, 16);
  for (std::int32_t m = 0; m < body.surface.element_count(); m += 7) {
    const Vec3 c = body.surface.position({m, {0.3, 0.3, 0.4}});
    const Delivery found = search.look({c, m});
    EXPECT_LE(found.elements().size(), 16U);
    for (const std::int32_t neighbour : ring_by_definition(body.surface, m)) {
      EXPECT_TRUE(found.holds(neighbour)) << "ring of " << m;
    }
  }
}

TEST(Search, LooksAheadAlongTheMotion) {
  // At 0.5 m/s over a fine mesh, what is delivered reaches where the tip will be two looks later.
  const palpate_library body(sphere(6, 0.03, varied()));
  Search search(body.surface, body.tree);
  const auto tip = [](double way) { return on_cylinder(way / 0.03, 0.029, 0.0); };
  const double step = 0.5 * 0.01;
  const auto element_at = [&](double way) { return body.tree.nearest(tip(way), 0.01).element; };
  search.look({tip(0), element_at(0)});
  const Delivery found = search.look({tip(step), element_at(step)});
  EXPECT_EQ(found.elements().size(), Delivery::kMost);
  EXPECT_TRUE(found.holds(element_at(2 * step)));
  EXPECT_TRUE(found.holds(element_at(2.9 * step)));
  EXPECT_FALSE(found.holds(element_at(-2 * step)));
}

TEST(Search, AFreeTipGetsBothSidesOfAGap) {
  // Between two plates that face each other, 4 mm apart, the tip may touch either next.
  Library library = thin_body(10, 0.1, -0.004, varied());
  const palpate_library body(library);
  Search search(body.surface, body.tree, 64);
  const Delivery found = search.look({{0.05, 0.05, 0.002}, kNoElement});
  const auto half = body.surface.element_count() / 2;
  const auto elements = found.elements();
  const auto low =
      std::count_if(elements.begin(), elements.end(), [&](auto m) { return m < half; });
  EXPECT_GT(low, 3);
  EXPECT_GT(static_cast<long>(elements.size()) - low, 3);
}

TEST(Multirate, TheForceIsThatOfTheSingleThreadBitForBit) {
  // 100 Hz beside 2 kHz, up to 1 m/s over patches of 10 mm, deliveries a full look late.
  const palpate_library& body = patches();
  ContactState alone(body.surface, body.tree, kSettings);
  ContactState together(body.surface, body.tree, kSettings);
  LockstepSearch search(body.surface, body.tree, 20, 32);
  const double dt = 5e-4;
  double angle = 0;
  double fastest = 0;
  int contacts = 0;
  Vec3 before{};
  for (int i = 0; i < 60000; ++i) {
    const double t = i * dt;
    angle += dt * 12 * std::sin(0.7 * t);
    const double depth = -0.004 * std::cos(2.1 * t);
    const Vec3 x = on_cylinder(angle, 0.04 - depth, 0.1 + 0.05 * std::sin(1.3 * t));
    if (i > 0) fastest = std::max(fastest, norm(x - before) / dt);
    before = x;
    const std::uint32_t expected = alone.step(x);
    const std::uint32_t status = search.step(together, x);
    ASSERT_EQ(status, expected) << "step " << i;
    ASSERT_EQ(together.observation().force, alone.observation().force) << "step " << i;
    contacts += status & PALPATE_ACTIVATED ? 1 : 0;
  }
  EXPECT_GT(contacts, 8);
  EXPECT_GT(fastest, 0.45);
}

TEST(Multirate, AFastTipStillTouchesWithinOneStep) {
  // Into the body at 1 m/s: collision is found in the force loop, so the offset at rest is what the
  // tip travels in one step of it, not in one look of the search (10 mm).
  const palpate_library& body = patches();
  for (double phase = 0; phase < 20; phase += 0.83) {
    ContactState contact(body.surface, body.tree, kSettings);
    LockstepSearch search(body.surface, body.tree, 20);
    std::uint32_t status = 0;
    for (int i = 0; !(status & PALPATE_ACTIVATED); ++i) {
      const double r = 0.08 - 5e-4 * (i + phase);
      ASSERT_GT(r, 0.03);
      status = search.step(contact, on_cylinder(1.1, r, 0.093));
    }
    EXPECT_LE(contact.observation().offset, 5.05e-4);
  }
}

TEST(Multirate, ATipThatOutranItsTrianglesIsCaughtByTheSearch) {
  // A long wait far away, then 33 m/s: no triangle has been delivered when the tip goes in. The
  // next look notices, and the contact begins late, without energy.
  const palpate_library& body = patches();
  ContactState contact(body.surface, body.tree, kSettings);
  LockstepSearch search(body.surface, body.tree, 20);
  std::uint32_t status = 0;
  for (int i = 0; i < 102; ++i) search.step(contact, on_cylinder(1.1, 0.20, 0.093));
  for (int i = 0; i <= 10; ++i) {
    status = search.step(contact, on_cylinder(1.1, 0.20 - 0.0165 * i, 0.093));
    EXPECT_FALSE(status & PALPATE_CONTACT);
  }
  for (int i = 0; i < 60 && !(status & PALPATE_ACTIVATED); ++i) {
    status = search.step(contact, on_cylinder(1.1, 0.035, 0.093));
  }
  EXPECT_TRUE(status & PALPATE_ACTIVATED);
  EXPECT_LE(contact.observation().energy, 1e-18);
  EXPECT_GT(contact.observation().offset, 0.0045);
}

TEST(Multirate, AtAnEdgeNotYetDeliveredTheContactPointWaits) {
  // Only the active triangle is there: the tool slips over its edge, and c catches up when the
  // neighbours arrive, which on equal springs is not felt.
  const palpate_library body(plate(10, 0.1, [](const Vec3&) { return wall_response(170, 170); }));
  ContactState contact(body.surface, body.tree, {0.1, 5e-3});
  Delivery one;
  const std::int32_t start = body.tree.nearest({0.042, 0.0415, 0}, 0.01).element;
  one.assign(std::array{start});
  contact.set_delivery(&one);
  contact.step({0.042, 0.0415, 1e-4});
  for (int i = 0; i <= 80; ++i) contact.step({0.042, 0.0415, -5e-5 * i});
  const double friction = 0.1 * norm(contact.observation().force);
  std::uint32_t seen = 0;
  Vec3 before = contact.observation().force;
  double steepest = 0;
  for (int i = 0; i <= 2000; ++i) {
    seen |= contact.step({0.042 + 1e-5 * i, 0.0415, -0.004});
    steepest = std::max(steepest, norm(contact.observation().force - before));
    before = contact.observation().force;
  }
  EXPECT_TRUE(seen & PALPATE_AWAITING);
  EXPECT_FALSE(seen & PALPATE_AT_BORDER);
  EXPECT_EQ(contact.observation().point.element, start);
  EXPECT_NEAR(contact.observation().force[0], friction, 1e-9);
  EXPECT_GT(norm(contact.observation().lateral_offset), 0.01);
  EXPECT_LE(steepest, 170 * 1e-5 + 1e-9);
  contact.set_delivery(nullptr);
  contact.step({0.062, 0.0415, -0.004});
  EXPECT_NEAR(contact.observation().contact_point[0], 0.062 - friction / 170, 1e-11);
  EXPECT_EQ(norm(contact.observation().lateral_offset), 0);
  EXPECT_NEAR(norm(contact.observation().force - before), 0, 1e-9);
}

}  // namespace
}  // namespace palpate::test
