// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/doctor/machine.hpp"

#include <gtest/gtest.h>

namespace palpate::app {
namespace {

TEST(Machine, IsLookedAt) {
  const Machine machine = look_at_machine("Haswell");
  EXPECT_GE(machine.processors, 1);
  EXPECT_GT(machine.memory, machine.available);
  EXPECT_GT(machine.available, 0);
  EXPECT_GE(machine.late_worst, machine.late_median);
  EXPECT_GE(machine.late_median, 0);
  EXPECT_GE(machine.early_worst, machine.early_median);
  EXPECT_GE(machine.early_median, 0);
  EXPECT_GT(machine.free_disk, 0);
  EXPECT_EQ(machine.libraries.size(), 3U);
}

}  // namespace
}  // namespace palpate::app
