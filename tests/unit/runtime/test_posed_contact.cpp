// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/posed_contact.hpp"

#include <gtest/gtest.h>

#include "runtime/handles.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::PosedContact;

TEST(PosedContact, CommandsAndObservesInTheWorld) {
  // A plate in z = 0 turned so that its outward normal +z becomes +x of the world.
  const palpate_library body(plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  PosedContact contact(body.surface, body.tree, {0.3, 5e-3}, 0);
  contact.pose = {{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}}, {1, 2, 3}};
  const auto at = [](double height) { return Vec3{1 + height, 2 + 0.033, 3 + 0.031}; };
  contact.step(at(1e-4));
  std::uint32_t status = 0;
  for (int i = 1; i <= 40; ++i) status = contact.step(at(-1e-4 * i));
  EXPECT_TRUE(status & runtime::step_status::Contact);
  const double z = 4e-3 - 1e-4;
  EXPECT_NEAR(norm(contact.command() - Vec3{100 * 170 * z * z, 0, 0}), 0, 1e-6);
  const auto seen = contact.observe();
  EXPECT_NEAR(norm(seen.contact_point - at(0)), 0, 1e-12);
  EXPECT_NEAR(norm(seen.normal - Vec3{-1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(norm(seen.force + contact.command()), 0, 1e-15);
}

TEST(PosedContact, WithASearchThreadMeetsNothingBeforeTheFirstDelivery) {
  const palpate_library body(plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  PosedContact contact(body.surface, body.tree, {0.3, 5e-3}, 1e-3);  // once in 1000 s
  for (int i = 0; i < 20; ++i) contact.step({0.033, 0.031, 5e-4 - 1e-4 * i});
  EXPECT_EQ(norm(contact.command()), 0);
}

}  // namespace
}  // namespace palpate::test
