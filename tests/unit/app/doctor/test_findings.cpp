// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "app/doctor/machine.hpp"

namespace palpate::app {
namespace {

constexpr double kGiB = 1024.0 * 1024 * 1024;

Machine good_machine() {
  Machine machine;
  machine.processors = 8;
  machine.memory = 32 * kGiB;
  machine.available = 20 * kGiB;
  machine.blas_kernel = "SkylakeX";
  machine.realtime_kernel = true;
  machine.late_median = 5e-6;
  machine.late_worst = 40e-6;
  machine.libraries = {{"Comedi", "lab-built devices", "apt install libcomedi0", true}};
  machine.folder = "/home/user";
  machine.free_disk = 100 * kGiB;
  return machine;
}

/// The only finding that is not ok.
std::string only_missing(const Machine& machine) {
  std::string text;
  for (const Finding& found : findings(machine)) {
    if (found.is_ok) continue;
    EXPECT_EQ(text, "");
    text = found.text;
  }
  return text;
}

TEST(Findings, OfAGoodMachineAreAllOk) {
  EXPECT_EQ(only_missing(good_machine()), "");
  EXPECT_EQ(findings(good_machine()).size(), 8U);
}

TEST(Findings, NameTheRemedyOfEachDefect) {
  Machine machine = good_machine();
  machine.available = kGiB;
  EXPECT_THAT(only_missing(machine),
              testing::HasSubstr("1.0 of 32.0 GiB available: give --memory"));
  machine = good_machine();
  machine.blas_kernel = "Prescott";
  EXPECT_THAT(only_missing(machine), testing::HasSubstr("OPENBLAS_CORETYPE"));
  machine = good_machine();
  machine.realtime_refusal = "no SCHED_FIFO priority: raise rtprio";
  EXPECT_EQ(only_missing(machine), "real-time rights: no SCHED_FIFO priority: raise rtprio");
  machine = good_machine();
  machine.late_worst = 2e-3;
  machine.early_median = 1e-6;
  machine.early_worst = 70e-6;
  EXPECT_THAT(only_missing(machine),
              testing::HasSubstr("2000 us at worst; that wakes 400 us early: 1 and 70 us"));
  EXPECT_THAT(only_missing(machine), testing::HasSubstr("--wake-early-us"));
  machine = good_machine();
  machine.libraries[0].found = false;
  EXPECT_THAT(only_missing(machine), testing::HasSubstr("apt install libcomedi0"));
  machine = good_machine();
  machine.free_disk = 0;
  EXPECT_THAT(only_missing(machine), testing::HasSubstr("/home/user: free some space"));
}

}  // namespace
}  // namespace palpate::app
