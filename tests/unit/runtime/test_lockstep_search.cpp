// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/lockstep_search.hpp"

#include <gtest/gtest.h>

#include "runtime/handles.hpp"
#include "runtime/status.hpp"
#include "tests/unit/runtime/loop_rig.hpp"

namespace palpate::test {
namespace {

using runtime::ContactState;
using runtime::LockstepSearch;
namespace step_status = runtime::step_status;

TEST(LockstepSearch, DeliversWithTheNextRunAndNotBefore) {
  // The first run is in step 0 and arrives in step 10; until then there is nothing to touch. In
  // step 10 the tip is inside already, and the entry that the search saw is acted upon.
  const palpate_library& body = plate_body();
  ContactState contact(body.surface, body.tree, {0.3, 5e-3});
  LockstepSearch search(body.surface, body.tree, 10);
  int first_contact = -1;
  for (int i = 0; i < 60 && first_contact < 0; ++i) {
    const Vec3 x{0.033, 0.031, 5e-4 - 1e-4 * i};
    if (search.step(contact, x) & step_status::Contact) first_contact = i;
  }
  EXPECT_GE(first_contact, 10);
  EXPECT_LE(first_contact, 20);
}

TEST(LockstepSearch, IsReproducible) {
  const palpate_library& body = plate_body();
  const auto play = [&] {
    ContactState contact(body.surface, body.tree, {0.3, 5e-3});
    LockstepSearch search(body.surface, body.tree, 20);
    Vec3 sum{};
    for (int i = 0; i < 1000; ++i) {
      search.step(contact, {0.02 + 4e-5 * i, 0.031, 5e-4 - 2e-5 * std::min(i, 200)});
      sum = sum + contact.observation().force;
    }
    return sum;
  };
  const Vec3 once = play();
  EXPECT_GT(norm(once), 1);
  EXPECT_EQ(play(), once);
}

}  // namespace
}  // namespace palpate::test
