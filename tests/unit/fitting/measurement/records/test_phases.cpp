// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "fitting/measurement/records/phases.hpp"

namespace palpate::measured {
namespace {

using testing::ElementsAre;

/// A test in which the travel goes through points (t, x), and the force is x less what relaxes.
struct Programme {
  std::vector<double> time, displacement, force;

  Programme(const std::vector<std::pair<double, double>>& points, double noise) {
    std::mt19937 engine(5);
    std::normal_distribution<double> scatter(0, noise);
    std::size_t k = 1;
    for (double t = 0; t < points.back().first - 1e-9; t += 0.01) {
      while (points[k].first <= t) ++k;
      const auto [t0, x0] = points[k - 1];
      const auto [t1, x1] = points[k];
      const double x = x0 + (x1 - x0) * (t - t0) / (t1 - t0);
      memory_ += x - last_ - 0.01 / 2 * memory_;
      last_ = x;
      time.push_back(t);
      displacement.push_back(x + 1e-3 * scatter(engine));
      force.push_back(std::max(0.0, x - 0.4 * (x - memory_)) + scatter(engine));
    }
  }

  PhaseSignals signals() const { return {time, displacement, displacement, force}; }

 private:
  double memory_ = 0, last_ = 0;
};

std::vector<PhaseKind> kinds(const std::vector<Phase>& phases) {
  std::vector<PhaseKind> out;
  for (const Phase& phase : phases) out.push_back(phase.kind);
  return out;
}

TEST(Phases, OfAHoldAreFoundWithTheirTimes) {
  const Programme test({{0, -0.5}, {1, -0.5}, {1.5, 0}, {2.5, 1}, {12.5, 1}, {13.5, 0}, {14, -0.5}},
                       0.002);
  EXPECT_EQ(control_of(test.signals()), Control::Travel);
  const std::vector<Phase> phases = phases_of(test.signals(), Control::Travel);
  ASSERT_THAT(kinds(phases), ElementsAre(PhaseKind::Rest, PhaseKind::Approach, PhaseKind::Ramp,
                                         PhaseKind::Hold, PhaseKind::Release));
  EXPECT_NEAR(test.time[phases[2].begin], 1.5, 0.02);
  EXPECT_NEAR(test.time[phases[3].begin], 2.5, 0.03);
  EXPECT_NEAR(test.time[phases[4].begin], 12.5, 0.03);
  for (std::size_t i = 1; i < phases.size(); ++i) EXPECT_EQ(phases[i].begin, phases[i - 1].end);
  EXPECT_EQ(phases.back().end, test.time.size());
}

TEST(Phases, OfCyclesHaveNoHold) {
  Programme test({{0, 0.01}, {10, 0.01}}, 0);
  for (std::size_t i = 0; i < test.time.size(); ++i) {
    const double x = 0.5 * (1 - std::cos(2 * std::numbers::pi * test.time[i] / 2.5));
    test.displacement[i] = 1e-3 * x + 1e-6;
    test.force[i] = x;
  }
  EXPECT_THAT(
      kinds(phases_of(test.signals(), Control::Travel)),
      ElementsAre(PhaseKind::Ramp, PhaseKind::Release, PhaseKind::Ramp, PhaseKind::Release,
                  PhaseKind::Ramp, PhaseKind::Release, PhaseKind::Ramp, PhaseKind::Release));
}

TEST(Phases, OfStepsHoldAtEachDepth) {
  const Programme test({{0, 0}, {0.5, 0.5}, {8, 0.5}, {8.5, 1}, {16, 1}, {16.5, 0.5}, {24, 0.5}},
                       0.001);
  EXPECT_THAT(kinds(phases_of(test.signals(), Control::Travel)),
              ElementsAre(PhaseKind::Ramp, PhaseKind::Hold, PhaseKind::Ramp, PhaseKind::Hold,
                          PhaseKind::Release, PhaseKind::Hold));
}

/// Force and travel change places: what was held as a travel is held as a force.
TEST(Phases, OfCreepAreThoseOfTheForce) {
  Programme test({{0, 0}, {1, 1}, {20, 1}}, 0.001);
  std::swap(test.displacement, test.force);
  for (std::size_t i = 0; i < test.time.size(); ++i)
    test.displacement[i] = test.force[i] * (2 - std::exp(-test.time[i] / 5));
  EXPECT_EQ(control_of(test.signals()), Control::Force);
  EXPECT_THAT(kinds(phases_of(test.signals(), Control::Force)),
              ElementsAre(PhaseKind::Ramp, PhaseKind::Hold));
}

TEST(Phases, HaveNames) {
  EXPECT_EQ(phase_name(PhaseKind::Release), "release");
  EXPECT_EQ(phase_of_name("rest"), PhaseKind::Rest);
  EXPECT_FALSE(phase_of_name("pause"));
}

}  // namespace
}  // namespace palpate::measured
