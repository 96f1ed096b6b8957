// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/cycles.hpp"

#include <gtest/gtest.h>

#include <random>

namespace palpate::measured {
namespace {

/// Waits of 10 samples, presses to 40 with a hold of 5, back to 0.
std::vector<double> presses(int count) {
  std::vector<double> x;
  for (int k = 0; k < count; ++k) {
    for (int i = 0; i < 10; ++i) x.push_back(0);
    for (int i = 1; i < 40; ++i) x.push_back(i);
    for (int i = 0; i < 5; ++i) x.push_back(40);
    for (int i = 39; i > 0; --i) x.push_back(i);
  }
  return x;
}

TEST(Cycles, BeginAfterTheWaitAndLeaveOutTheHold) {
  const std::vector<double> x = presses(3);
  const std::vector<Cycle> cycles = cycles_of(x);
  ASSERT_EQ(cycles.size(), 3U);
  const std::size_t period = 93;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(cycles[k].begin, period * k + 9);
    EXPECT_EQ(x[cycles[k].peak], 40);
    EXPECT_EQ(x[cycles[k].loading_end - 1], 40);
    EXPECT_EQ(x[cycles[k].loading_end - 2], 39);
    EXPECT_EQ(x[cycles[k].unloading_begin], 40);
    EXPECT_EQ(x[cycles[k].unloading_begin + 1], 39);
    EXPECT_EQ(cycles[k].before, k == 0 ? 0 : cycles[k - 1].peak);
  }
  EXPECT_TRUE(cycles_of(std::vector<double>(20, 1.0)).empty());
}

TEST(Cycles, NoiseIsSeenThroughAMovement) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal(0, 0.1);
  std::vector<double> x;
  for (int i = 0; i < 2000; ++i) x.push_back(1e-6 * i * i + normal(engine));
  EXPECT_NEAR(noise_of(x), 0.1, 0.01);
}

}  // namespace
}  // namespace palpate::measured
