// SPDX-License-Identifier: AGPL-3.0-or-later
// Tissue that relaxes, against closed forms, a differential equation and a balance of energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "runtime/contact_state.hpp"
#include "runtime/handles.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

const std::vector<double> kTimes{0.02, 0.3};  // s, with a fraction of 1/4 each
constexpr double kLongTerm = 0.5;             // g_inf
constexpr double kInstant = 1e-12;            // s, as good as no time

double prony(double t) {
  return kLongTerm + 0.25 * std::exp(-t / kTimes[0]) + 0.25 * std::exp(-t / kTimes[1]);
}

NodeResponse spring(const Vec3&) {
  NodeResponse node = wall_response(200, 120);
  node.normal = linear_curve(200);
  return node;
}
NodeResponse wall(const Vec3&) {
  return wall_response(170, 120);
}

/// A tool on a plate that relaxes, pressed along -z.
class Pressed {
 public:
  explicit Pressed(const Responses& responses, double friction = 0, double tank_cap = 0)
      : library_(relaxing(plate(8, 0.08, responses), kTimes, true)),
        body_(library_),
        contact_(body_.surface, body_.tree, {friction, tank_cap}) {
    to(-1e-9, kInstant);  // 1 nm outside
    to(1e-12, kInstant);
  }

  /// Moves the tool to a depth (m), dt (s) after the last step. @return normal force, N
  double to(double depth, double dt) {
    depth_ = depth;
    contact_.step({x_, 0.031, -depth}, dt);
    return -seen().force[2];
  }
  /// In equal steps of dt.
  double ramp(double depth, double time, int steps) {
    const double from = depth_;
    double force = 0;
    for (int i = 1; i <= steps; ++i) force = to(from + (depth - from) * i / steps, time / steps);
    return force;
  }
  double hold(double time, int steps = 1) { return ramp(depth_, time, steps); }
  void slide(double distance, int steps, double dt) {
    for (int i = 0; i < steps; ++i) {
      x_ += distance / steps;
      to(depth_, dt);
    }
  }
  const runtime::ContactObservation& seen() const { return contact_.observation(); }
  runtime::ContactState& contact() { return contact_; }
  double radius() const { return library_.tool_radius; }

 private:
  Library library_;
  palpate_library body_;
  runtime::ContactState contact_;
  double depth_ = 0, x_ = 0.022;
};

TEST(Relaxation, AHoldRelaxesAsThePronySeriesAtEveryDepthAndForEverySequenceOfSteps) {
  for (const double depth : {1e-4, 2e-3, 6e-3}) {
    Pressed tool(wall);
    const double first = tool.ramp(depth, kInstant, 7);
    double time = 0;
    for (const double dt : {1e-4, 3e-3, 1e-6, 0.05, 0.2, 0.7}) {
      time += dt;
      EXPECT_NEAR(tool.to(depth, dt) / first, prony(time), 1e-9) << depth << " " << time;
      EXPECT_NEAR(tool.seen().relaxed_fraction, 1 - prony(time), 1e-9);
    }
  }
}

TEST(Relaxation, AFastPressFeelsTheCurveAndASlowOneItsLongTermFraction) {
  const double curve = 170 * 100 * 4e-3 * 4e-3;
  Pressed fast(wall), slow(wall);
  EXPECT_NEAR(fast.ramp(4e-3, 1e-6, 20), curve, 1e-4 * curve);
  EXPECT_NEAR(slow.ramp(4e-3, 3000, 20000), kLongTerm * curve, 1e-3 * curve);
}

constexpr double kWall = 170 * 100;  // N/m^2: the wall's force is kWall z^2

/// f(t) = integral of g(t - s) d(kWall (v s)^2), the law of Fung for a ramp.
double ramp_in_closed_form(double speed, double t) {
  double force = kLongTerm * t * t;
  for (const double tau : kTimes) force += 0.25 * 2 * tau * (t - tau * (1 - std::exp(-t / tau)));
  return kWall * speed * speed * force;
}

TEST(Relaxation, ARampConvergesToTheLawOfFungWithTheFirstOrderOfTheStep) {
  for (const double time : {0.01, 0.1, 1.0}) {
    const double exact = ramp_in_closed_form(4e-3 / time, time);
    double before = 0;
    for (const int steps : {100, 200, 400, 800}) {
      Pressed tool(wall);
      const double error = std::abs(tool.ramp(4e-3, time, steps) - exact);
      if (before > 0) {
        EXPECT_NEAR(before / error, 2, 0.1) << time << " " << steps;
      }
      before = error;
    }
    EXPECT_LT(before, 2e-3 * exact);
  }
}

/// The force of the law of Fung after a path, the convolution summed over its samples.
double hereditary_force(const std::vector<double>& depths, double dt) {
  double force = 0, last = 0;
  for (std::size_t k = 0; k < depths.size(); ++k) {
    const double elastic = kWall * depths[k] * depths[k];
    force += prony(dt * (static_cast<double>(depths.size() - 1 - k) + 0.5)) * (elastic - last);
    last = elastic;
  }
  return force;
}

TEST(Relaxation, CyclesOfAnySizeFollowTheConvolutionOfFung) {
  constexpr double kDt = 1e-4;
  for (const double swing : {0.1, 0.4}) {
    Pressed tool(wall);
    std::vector<double> depths;
    double worst = 0;
    for (int k = 1; k <= 4000; ++k) {
      const double rise = std::min(k / 500.0, 1.0);
      depths.push_back(4e-3 * rise * (1 - swing * (1 - std::cos(0.01 * k)) / 2));
      const double force = tool.to(depths.back(), kDt);
      if (k % 50 == 0) worst = std::max(worst, std::abs(force - hereditary_force(depths, kDt)));
    }
    EXPECT_LT(worst, 2e-3 * kWall * 16e-6) << swing;
  }
}

TEST(Relaxation, TheEnergyIsThatOfConvexElements) {
  // G = k z^3/3 has the conjugate G*(F) = (2/3) F^1.5/sqrt(k). After an instant press and a time t
  // every branch has relaxed g (1 - exp(-t/tau)).
  Pressed tool(wall);
  const double g = tool.ramp(4e-3, kInstant, 7);
  double dissipated = 0;
  for (const double t : {0.01, 0.1, 1.0}) {
    Pressed held(wall);
    held.ramp(4e-3, kInstant, 7);
    held.hold(t);
    double energy = kWall * 64e-9 / 3;
    for (const double tau : kTimes) {
      const double relaxed = g * (1 - std::exp(-t / tau));
      energy += 0.25 * (2.0 / 3 * std::pow(relaxed, 1.5) / std::sqrt(kWall) - relaxed * 4e-3);
    }
    EXPECT_NEAR(held.seen().energy, energy, 1e-7 * energy);  // knots are stored in single precision
    EXPECT_GT(held.seen().dissipated, dissipated);
    dissipated = held.seen().dissipated;
  }
}

TEST(Relaxation, WhenTheToolIsWithdrawnTheSkinLagsBehindAndComesBack) {
  Pressed tool(spring);
  tool.ramp(4e-3, kInstant, 4);
  tool.hold(1000);
  // The force is proportional to the depth: the relaxed skin rests at 1 - g_inf of it.
  const double skin = (1 - kLongTerm) * 4e-3;
  EXPECT_GT(tool.ramp(1.001 * skin, kInstant, 50), 0);
  EXPECT_FALSE(tool.seen().status & PALPATE_SKIN_LAGS);
  EXPECT_EQ(tool.to(0.999 * skin, kInstant), 0);
  EXPECT_TRUE(tool.seen().status & PALPATE_SKIN_LAGS);
  EXPECT_TRUE(tool.seen().status & PALPATE_CONTACT);
  // Back at the tool after a while, and then with more and more of the long-term force.
  const double again = tool.hold(0.4, 4000);
  EXPECT_GT(again, 0);
  EXPECT_NEAR(tool.hold(1000), kLongTerm * 200 * 0.999 * skin, 1e-6);
}

TEST(Relaxation, FreeSkinRecoversAtTheRateOfItsLongTermStiffness) {
  // One branch: F' = -g_inf F/tau while nothing touches.
  Library library = relaxing(plate(8, 0.08, spring), {0.1}, true);
  const palpate_library body(library);
  runtime::ContactState contact(body.surface, body.tree, {0, 0});
  const auto at = [&](double depth, double dt) {
    contact.step({0.022, 0.031, -depth}, dt);
    return -contact.observation().force[2];
  };
  at(-1e-9, kInstant);
  at(1e-12, kInstant);
  for (int i = 1; i <= 10; ++i) at(4e-4 * i, kInstant);
  at(4e-3, 100);
  EXPECT_EQ(at(-1e-6, kInstant), 0);
  EXPECT_TRUE(contact.observation().status & PALPATE_RELEASED);
  for (int i = 0; i < 20000; ++i) at(-1e-6, 1e-5);  // 0.2 s
  const double skin = 0.5 * 4e-3 * std::exp(-0.5 * 0.2 / 0.1);
  at(1e-12, kInstant);
  EXPECT_EQ(at(0.995 * skin, kInstant), 0);
  EXPECT_NEAR(at(skin + 1e-4, kInstant), 200 * 1e-4, 200 * 0.005 * skin);
}

TEST(Relaxation, WorkIsWhatIsStoredAndWhatIsDissipated) {
  Pressed tool(wall);
  double dt = 0, loop = 0, last = 0, force = 0;
  for (int i = 0; i < 40000; ++i) {
    dt = 1e-5 * (1 + std::sin(i));
    const double depth = 2e-3 - 1.99e-3 * std::cos(2e-4 * i);
    const double before = force;
    force = tool.to(depth, dt);
    loop += (force + before) / 2 * (depth - last);
    last = depth;
    const auto& seen = tool.seen();
    EXPECT_NEAR(seen.absorbed, seen.energy + seen.dissipated, 1e-15);
  }
  EXPECT_GT(tool.seen().dissipated, 1e-5);
  // The account is that of the forces over the path, but for the length of the steps.
  EXPECT_NEAR(loop, tool.seen().absorbed, 0.01 * tool.seen().absorbed);
}

TEST(Relaxation, ASlideLeavesTheMemoryBehindOverTheRadiusOfTheTool) {
  Pressed tool(wall, 0.3, 5e-3);
  const double first = tool.ramp(3e-3, kInstant, 10);
  tool.hold(1000);
  EXPECT_NEAR(-tool.seen().force[2], kLongTerm * first, 1e-6);
  const Vec3 from = tool.seen().contact_point;
  tool.slide(0.008, 400, kInstant);
  const double slid = norm(tool.seen().contact_point - from);
  EXPECT_GT(slid, 0.004);
  EXPECT_EQ(tool.seen().offset, 1e-12);  // friction has paid for the fresh tissue
  EXPECT_NEAR(-tool.seen().force[2], (1 - kLongTerm * std::exp(-slid / tool.radius())) * first,
              1e-6);
  EXPECT_NEAR(norm(tool.seen().force - (tool.seen().force[2] * Vec3{0, 0, 1})),
              -0.3 * tool.seen().force[2], 1e-3);
}

TEST(Relaxation, WhatASlideToSofterTissueLeavesDoesNotDependOnTheNumberOfSteps) {
  const auto softer = [](const Vec3& at) { return wall_response(170 / (1 + 60 * at[0]), 120); };
  std::vector<double> left;
  for (const int steps : {200, 20000}) {
    Pressed tool(softer, 0.3, 5e-3);
    tool.ramp(3e-3, kInstant, 10);
    tool.hold(1000);
    tool.slide(0.002, steps, kInstant);
    left.push_back(tool.seen().relaxed_fraction);
  }
  EXPECT_GT(left[0], 0.1);
  EXPECT_NEAR(left[1], left[0], 0.01);
}

TEST(Relaxation, WithoutFrictionFreshTissueCostsDepthInsteadOfEnergy) {
  Pressed tool(wall);
  tool.ramp(3e-3, kInstant, 10);
  tool.hold(1000);
  const runtime::ContactObservation before = tool.seen();
  tool.slide(0.02, 20000, kInstant);
  const double paid = tool.seen().absorbed - before.absorbed;  // c follows a step late
  EXPECT_LE(tool.seen().energy, before.energy + paid + 1e-15);
  EXPECT_LT(paid, 0.03 * before.energy);
  EXPECT_GT(tool.seen().offset, 2e-4);
}

TEST(Relaxation, FrictionLetsGoOfWhatANormalForceThatRelaxesNoLongerHolds) {
  Pressed tool(wall, 0.3, 5e-3);
  const double first = tool.ramp(3e-3, kInstant, 10);
  tool.slide(0.003, 100, kInstant);
  const auto lateral = [&] { return std::hypot(tool.seen().force[0], tool.seen().force[1]); };
  EXPECT_GT(lateral(), 0.25 * first);
  for (const double dt : {0.01, 0.1, 1.0}) {
    tool.hold(dt);
    EXPECT_LE(lateral(), -0.3 * tool.seen().force[2] + 0.02);
  }
}

TEST(Relaxation, AClockThatGoesBackPassesNoTime) {
  Pressed tool(wall);
  const double first = tool.ramp(3e-3, kInstant, 10);
  for (const double dt : {-1.0, -1e9, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_NEAR(tool.to(3e-3, dt), first, 1e-9 * first) << dt;
}

TEST(Relaxation, ElasticResponsesDoNotDependOnTime) {
  const Library library = plate(8, 0.08, wall);
  const palpate_library body(library);
  runtime::ContactState one(body.surface, body.tree, {0.3, 5e-3});
  runtime::ContactState other(body.surface, body.tree, {0.3, 5e-3});
  for (int i = 0; i < 600; ++i) {
    const Vec3 x{0.02 + 2e-5 * i, 0.031, 1e-3 - 2e-5 * std::min(i, 200)};
    one.step(x, 1e-3 * i);
    other.step(x);
    EXPECT_EQ(one.observation().force, other.observation().force);
    EXPECT_EQ(one.observation().dissipated, 0);
    EXPECT_EQ(one.observation().relaxed_fraction, 0);
  }
}

TEST(Relaxation, WhatDropsTheContactMakesTheTissueAsNew) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const int way : {0, 1, 2}) {
    Pressed tool(wall);
    const double first = tool.ramp(3e-3, kInstant, 10);
    tool.hold(1000);
    if (way == 0) tool.contact().step({kNan, 0, 0}, 1e-3);
    if (way == 1) tool.contact().suspend({0.022, 0.031, -3e-3});
    if (way == 2) tool.contact().reset();
    EXPECT_EQ(tool.seen().energy, 0);
    tool.to(-1e-6, kInstant);
    tool.to(1e-12, kInstant);
    EXPECT_NEAR(tool.ramp(3e-3, kInstant, 10), first, 1e-9 * first) << way;
  }
}

TEST(Relaxation, IsRefusedWhereNodesLackFractionsOrTheToolARadius) {
  Library library = relaxing(plate(4, 0.04, wall), kTimes, true);
  EXPECT_NO_THROW(palpate_library{library});
  Library lacking = library;
  lacking.responses[3].relaxation.pop_back();
  EXPECT_ANY_THROW(palpate_library{lacking});
  library.tool_radius = 0;
  EXPECT_ANY_THROW(palpate_library{library});
}

/// A fraction of 1/2 in this many parts, all of one relaxation time.
Library in_parts(std::size_t parts, ResponseKind kind) {
  Library library = plate(8, 0.08, wall);
  if (kind == ResponseKind::Coupled) library = coupled(library);
  library.tool_radius = 0.005;
  library.relaxation_times.assign(parts, 0.05);
  const float first = 0.5F - static_cast<float>(parts - 1) / 16;
  for (NodeResponse& response : library.responses) {
    response.relaxation.assign(parts, 1.0F / 16);
    response.relaxation.front() = first;
  }
  return library;
}

/// Presses and drags with pauses, slides and a lift, at times that vary from step to step. Energies
/// are asked for after every so many steps; those of the others are not known.
std::vector<runtime::ContactObservation> felt_by_a_wandering_tool(const Library& library,
                                                                  int asked_every = 1) {
  const palpate_library body(library);
  runtime::ContactState contact(body.surface, body.tree, {0.3, 5e-3});
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<runtime::ContactObservation> felt;
  double phase = 0;
  for (int i = 0; i < 4000; ++i) {
    const double dt = 0.02 * std::pow(any(random), 4);
    if (i % 400 < 300) phase += 0.02 * any(random);
    contact.step({0.04 + 0.02 * std::sin(phase), 0.04 + 0.015 * std::sin(1.7 * phase),
                  -0.002 + 0.003 * std::cos(0.9 * phase)},
                 dt);
    felt.push_back(i % asked_every == 0 ? contact.observation()
                                        : contact.observation_but_energies());
  }
  return felt;
}

TEST(Relaxation, NothingDependsOnWhoAsksForEnergies) {
  constexpr int kSeldom = 37;
  for (const ResponseKind kind : {ResponseKind::Decoupled, ResponseKind::Coupled}) {
    const Library library = in_parts(3, kind);
    const auto always = felt_by_a_wandering_tool(library);
    const auto seldom = felt_by_a_wandering_tool(library, kSeldom);
    for (std::size_t i = 0; i < always.size(); ++i) {
      ASSERT_EQ(seldom[i].force, always[i].force) << i;
      ASSERT_EQ(seldom[i].status, always[i].status) << i;
      ASSERT_EQ(seldom[i].tank, always[i].tank) << i;
      if (i % kSeldom != 0) continue;
      ASSERT_EQ(seldom[i].energy, always[i].energy) << i;
      ASSERT_EQ(seldom[i].absorbed, always[i].absorbed) << i;
      ASSERT_EQ(seldom[i].dissipated, always[i].dissipated) << i;
    }
  }
}

TEST(Relaxation, APressThatIsAskedAtItsEndAloneAccountsForTheSame) {
  constexpr int kSteps = 985000;  // 31 cycles in which the skin comes to lag, and half a press
  Pressed always(wall), once(wall);
  double force_always = 0, force_once = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double depth = 2e-3 - 1.5e-3 * std::cos(2e-4 * i), dt = 1e-5 * (1 + std::sin(i));
    const Vec3 tip{0.022, 0.031, -depth};
    once.contact().step(tip, dt);
    always.contact().step(tip, dt);
    force_once = once.contact().observation_but_energies().force[2];
    force_always = always.seen().force[2];
    ASSERT_EQ(force_once, force_always) << i;
  }
  EXPECT_LT(force_once, -0.01);
  EXPECT_GT(once.seen().dissipated, 1e-4);
  EXPECT_EQ(once.seen().energy, always.seen().energy);
  EXPECT_EQ(once.seen().dissipated, always.seen().dissipated);
  EXPECT_EQ(once.seen().absorbed, always.seen().absorbed);
  EXPECT_NEAR(once.seen().absorbed, once.seen().energy + once.seen().dissipated, 1e-15);
}

TEST(Relaxation, HowManyBranchesAFractionIsDividedIntoMakesNoDifference) {
  for (const ResponseKind kind : {ResponseKind::Decoupled, ResponseKind::Coupled}) {
    const auto one = felt_by_a_wandering_tool(in_parts(1, kind));
    double dissipated = 0;
    for (const std::size_t parts : {2U, 3U, 5U, 8U}) {
      const auto felt = felt_by_a_wandering_tool(in_parts(parts, kind));
      for (std::size_t i = 0; i < felt.size(); ++i) {
        ASSERT_LT(norm(felt[i].force - one[i].force), 1e-9) << parts << " " << i;
        ASSERT_NEAR(felt[i].energy, one[i].energy, 1e-12) << parts << " " << i;
        ASSERT_NEAR(felt[i].dissipated, one[i].dissipated, 1e-11) << parts << " " << i;
      }
      dissipated = felt.back().dissipated;
    }
    EXPECT_GT(dissipated, 1e-4);
  }
}

}  // namespace
}  // namespace palpate::test
