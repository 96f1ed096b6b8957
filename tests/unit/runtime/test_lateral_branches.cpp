// SPDX-License-Identifier: AGPL-3.0-or-later
// The lateral response of tissue that relaxes, against Maxwell elements in closed form, the law
// integrated by itself, and a balance of energy.
#include "runtime/lateral_branches.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include "runtime/contact_state.hpp"
#include "runtime/handles.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

const std::vector<double> kTimes{0.02, 0.3};  // s, with a fraction of 1/4 each
constexpr double kLongTerm = 0.5;             // g_inf
constexpr double kInstant = 1e-12;            // s, as good as no time
constexpr double kSticks = 50;                // a friction coefficient with which nothing slips
constexpr double kSpring = 120;               // N/m

double prony(double t) {
  return kLongTerm + 0.25 * std::exp(-t / kTimes[0]) + 0.25 * std::exp(-t / kTimes[1]);
}

NodeResponse straight(const Vec3&) {
  return wall_response(170, kSpring);
}
/// h(rho) = 60 rho + 15000 rho^2 up to 8 mm.
NodeResponse stiffening(const Vec3&) {
  NodeResponse node = wall_response(170, 1);
  node.lateral = stiffening_curve(60, 300, 5, 0.002);
  return node;
}
double stiffening_force(double rho) {
  return 60 * rho + 15000 * rho * rho;
}

/// A tool pressed 3 mm into a plate that relaxes, and dragged over it.
class Dragged {
 public:
  explicit Dragged(const Responses& responses, double friction = kSticks)
      : Dragged(plate(8, 0.08, responses), friction) {}
  explicit Dragged(const Library& elastic, double friction = kSticks)
      : library_(relaxing(elastic, kTimes, true)),
        body_(library_),
        contact_(body_.surface, body_.tree, {friction, 5e-3}) {
    for (int i = -1; i <= 10; ++i) press(i < 0 ? -1e-9 : 1e-12 + 3e-4 * i);
  }

  void press(double depth) {
    depth_ = depth;
    to(x_, y_, kInstant);
  }
  /// To a place from that of the press (m), dt (s) after the last step. @return f_t, N
  Vec3 to(double x, double y, double dt) {
    x_ = x;
    y_ = y;
    contact_.step({0.022 + x, 0.031 + y, -depth_}, dt);
    return lateral();
  }
  Vec3 ramp(double x, double y, double time, int steps) {
    const double from_x = x_, from_y = y_;
    for (int i = 1; i <= steps; ++i) {
      const double s = static_cast<double>(i) / steps;
      to(from_x + s * (x - from_x), from_y + s * (y - from_y), time / steps);
    }
    return lateral();
  }
  Vec3 hold(double time) { return to(x_, y_, time); }
  Vec3 lateral() const { return {seen().force[0], seen().force[1], 0}; }
  const runtime::ContactObservation& seen() const { return contact_.observation(); }
  double radius() const { return library_.tool_radius; }
  double depth() const { return depth_; }

 private:
  Library library_;
  palpate_library body_;
  runtime::ContactState contact_;
  double x_ = 0, y_ = 0, depth_ = 0;
};

TEST(LateralBranches, DragsOverThreeDecadesAndHoldsAreThoseOfMaxwellElements) {
  constexpr double kDrag = 1.5e-3;
  for (const double time : {0.01, 0.1, 1.0, 10.0}) {
    Dragged tool(straight);
    const double rate = kSpring * kDrag / time;  // N/s
    double expected = kLongTerm * kSpring * kDrag;
    for (const double tau : kTimes) expected += 0.25 * rate * tau * (1 - std::exp(-time / tau));
    EXPECT_NEAR(tool.ramp(kDrag, 0, time, 4000)[0], expected, 1e-4 * kSpring * kDrag) << time;
    double held = 0;
    for (const double more : {0.005, 0.05, 0.7}) {
      held += more;
      expected = kLongTerm * kSpring * kDrag;
      for (const double tau : kTimes)
        expected += 0.25 * rate * tau * (1 - std::exp(-time / tau)) * std::exp(-held / tau);
      EXPECT_NEAR(tool.hold(more)[0], expected, 1e-4 * kSpring * kDrag) << time << " " << held;
    }
  }
}

TEST(LateralBranches, AHoldRelaxesAsThePronySeriesAtEveryDeflection) {
  for (const double drag : {1e-4, 1e-3, 4e-3}) {
    Dragged tool(stiffening);
    const double first = tool.ramp(drag, 0, kInstant, 5)[0];
    EXPECT_NEAR(first, stiffening_force(drag), 1e-6 * first);
    double time = 0;
    for (const double dt : {1e-4, 3e-3, 1e-6, 0.05, 0.2, 0.7}) {
      time += dt;
      EXPECT_NEAR(tool.hold(dt)[0] / first, prony(time), 1e-9) << drag << " " << time;
      EXPECT_NEAR(tool.seen().relaxed_lateral_force[0] / first, 1 - prony(time), 1e-9);
    }
  }
}

/// The law by itself, in steps of the middle: M_i' = (h t - M_i)/tau_i.
class LawOfFung {
 public:
  void pass(const Vec3& q, double dt) {
    const Vec3 force = instant(q);
    for (std::size_t i = 0; i < kTimes.size(); ++i) {
      const double a = dt / (2 * kTimes[i]);
      memory_[i] = (1 / (1 + a)) * ((1 - a) * memory_[i] + (2 * a) * force);
    }
  }
  Vec3 force(const Vec3& q) const { return instant(q) - 0.25 * (memory_[0] + memory_[1]); }

 private:
  static Vec3 instant(const Vec3& q) {
    const double rho = norm(q);
    return rho > 0 ? (stiffening_force(rho) / rho) * q : Vec3{};
  }
  std::array<Vec3, 2> memory_{};
};

TEST(LateralBranches, ADragRoundCornersConvergesToTheLawWithTheFirstOrderOfTheStep) {
  const auto path = [](double t) {  // s, to m
    return Vec3{2e-3 * std::sin(9 * t), 3e-3 * t - 1e-3 * std::sin(23 * t), 0};
  };
  constexpr double kEnd = 0.6, kFine = 2e-6;
  LawOfFung law;
  for (int i = 0; i * kFine < kEnd - kFine / 2; ++i) law.pass(path((i + 0.5) * kFine), kFine);
  const Vec3 exact = law.force(path(kEnd));
  double before = 0;
  for (const int steps : {300, 600, 1200}) {
    Dragged tool(stiffening);
    for (int i = 1; i <= steps; ++i) {
      const Vec3 q = path(kEnd * i / steps);
      tool.to(q[0], q[1], kEnd / steps);
    }
    const double error = norm(tool.lateral() - exact);
    if (before > 0) {
      EXPECT_NEAR(before / error, 2, 0.15) << steps;
    }
    before = error;
  }
  EXPECT_LT(before, 3e-3 * norm(exact));
}

TEST(LateralBranches, WorkIsWhatIsStoredAndWhatIsDissipated) {
  Dragged tool(stiffening);
  const double pressed = tool.seen().absorbed;
  double work = 0;
  Vec3 last{}, force{};
  for (int i = 1; i <= 20000; ++i) {
    const Vec3 q{2e-3 * std::sin(1e-3 * i), 1e-3 * std::sin(2.3e-3 * i), 0};
    const Vec3 before = force;
    force = tool.to(q[0], q[1], 1e-4 * (1 + std::sin(i)));
    work += dot(0.5 * (force + before), q - last);
    last = q;
    EXPECT_NEAR(tool.seen().absorbed, tool.seen().energy + tool.seen().dissipated, 1e-15);
  }
  const double dragged = tool.seen().absorbed - pressed;
  EXPECT_GT(dragged, 1e-5);
  EXPECT_NEAR(work, dragged, 0.01 * dragged);
}

TEST(LateralBranches, ASteadySlideShearsTheTissueTheMoreTheSlowerItIs) {
  // M_i' = (k q - M_i)/tau_i - v M_i/R_t = 0, and friction holds k q - M = mu psi g.
  constexpr double kFriction = 0.3;
  for (const double speed : {0.003, 0.03, 0.3}) {
    Dragged tool(straight, kFriction);
    const double distance = 0.03;
    tool.ramp(distance, 0, distance / speed, 30000);
    double left = 1;
    for (const double tau : kTimes) left -= 0.25 / (1 + speed * tau / tool.radius());
    const double limit = -kFriction * tool.seen().force[2];
    EXPECT_NEAR(tool.lateral()[0], limit, 1e-3 * limit) << speed;
    EXPECT_NEAR(tool.seen().deflection.lateral, limit / left / kSpring,
                5e-3 * limit / left / kSpring)
        << speed;
    EXPECT_NEAR(left, tool.seen().relaxed_fraction < 1 ? 1 - tool.seen().relaxed_fraction : 0,
                5e-3);  // the normal response, by the same law
  }
}

TEST(LateralBranches, TheToolSlipsOnlyAgainstTheForceThatIsFelt) {
  constexpr double kFriction = 0.3;
  Dragged tool(stiffening, kFriction);
  tool.ramp(3e-3, 0, 0.1, 100);
  tool.hold(1);
  for (int i = 1; i <= 200; ++i) {  // across the drag that the tissue remembers
    const Vec3 anchor = tool.seen().contact_point + tool.seen().lateral_offset;
    const Vec3 force = tool.to(3e-3, 2e-5 * i, 1e-3);
    const Vec3 slip = tool.seen().contact_point + tool.seen().lateral_offset - anchor;
    EXPECT_GE(dot(slip, force), -1e-15) << i;
    EXPECT_LE(norm(force), -kFriction * tool.seen().force[2] + 0.01) << i;
  }
  EXPECT_GT(tool.lateral()[1], 2 * std::abs(tool.lateral()[0]));
}

/// M, with a K of 1 J.
runtime::LateralMemory remembered(const Vec3& relaxed) {
  runtime::LateralMemory memory;
  memory.relaxed_xy = runtime::Pair{relaxed[0], relaxed[1]};
  memory.relaxed_z = runtime::Pair{relaxed[2], 0};
  memory.stored_and_carried = runtime::Pair{1, 1};
  memory.any = true;
  return memory;
}

TEST(LateralBranches, SlipAtAFixedPointKeepsTheDirectionOfTheForceAndLowersTheEnergy) {
  const Library library = relaxing(plate(2, 0.08, stiffening), kTimes, true);
  const palpate_library body(library);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  runtime::ToolPieces pieces;
  for (int trial = 0; trial < 1000; ++trial) {
    runtime::LocalModel model(body.surface, {0, {0.2, 0.5, 0.3}}, 0);
    const Vec3 memory{0.2 * any(random), 0.2 * any(random), 0};
    model.set_memory({{}, remembered(memory)});
    auto d = model.deflection(model.contact_point() +
                              Vec3{4e-3 * any(random), 4e-3 * any(random), -2e-3});
    auto at = model.respond(d, pieces);
    const auto before = at;
    const double limit = (trial % 5 == 0 ? 0 : 0.9) * std::abs(any(random)) * at.lateral_force;
    const auto slip = model.slip_within(d, at, limit, pieces);
    model.slip(slip, d, at, pieces);
    EXPECT_NEAR(at.lateral_force, limit, 1e-12);
    const Vec3 lateral = at.force - dot(at.force, model.normal()) * model.normal();
    const Vec3 was = before.force - dot(before.force, model.normal()) * model.normal();
    EXPECT_NEAR(norm(lateral - (limit / norm(was)) * was), 0, 1e-12);
    EXPECT_LE(at.energy, before.energy - dot(slip.part(1), lateral) + 1e-15);
    EXPECT_GE(dot(slip.part(1), was), 0);
  }
}

TEST(LateralBranches, AtTheLimitOfFrictionTheForceIsNoSteeperThanItsBound) {
  constexpr double kFriction = 0.7, kSmall = 1e-8;
  const Library library = relaxing(plate(2, 0.08, stiffening), kTimes, true);
  const palpate_library body(library);
  // (R27): the steepest slope of the normal and of the lateral response, 170 N/m and 300 N/m.
  const double normal = std::sqrt(1 + kFriction * kFriction) * 170;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> any(-1, 1);
  double steepest_press = 0, steepest = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    runtime::LocalModel model(body.surface, {0, {0.2, 0.5, 0.3}}, 0);
    model.set_memory({{runtime::Pair{0.1 * std::abs(any(random)), 1}, runtime::Pair{0, 1}},
                      remembered({0.5 * any(random), 0.5 * any(random), 0})});
    const auto force = [&](const Vec3& x) {
      runtime::LocalModel slipped = model;
      runtime::ToolPieces pieces;
      auto d = slipped.deflection(x);
      auto at = slipped.respond(d, pieces);
      const double limit = kFriction * at.friction_normal_force;
      if (at.lateral_force > limit)
        slipped.slip(slipped.slip_within(d, at, limit, pieces), d, at, pieces);
      return at.force;
    };
    const Vec3 x = model.contact_point() +
                   Vec3{9e-3 * any(random), 9e-3 * any(random), -6e-3 * std::abs(any(random))};
    const Vec3 step{any(random), any(random), any(random)};
    const double slope =
        norm(force(x + kSmall * step) - force(x - kSmall * step)) / (2 * kSmall * norm(step));
    const double press = norm(force(x - Vec3{0, 0, kSmall}) - force(x)) / kSmall;
    EXPECT_LE(press, normal * (1 + 1e-5));
    EXPECT_LE(slope, 300 * (1 + 1e-5));
    steepest_press = std::max(steepest_press, press);
    steepest = std::max(steepest, slope);
  }
  EXPECT_GT(steepest_press, 0.99 * normal);
  EXPECT_GT(steepest, 0.7 * 300);
}

TEST(LateralBranches, TissueThatTheToolHasLeftRemembersNoDrag) {
  Dragged tool(straight);
  tool.ramp(2e-3, 0, 0.5, 100);
  EXPECT_GT(norm(tool.seen().relaxed_lateral_force), 0.02);
  tool.press(-1e-6);
  EXPECT_EQ(tool.seen().relaxed_lateral_force, Vec3{});
  for (int i = 0; i <= 10; ++i) tool.press(1e-12 + 3e-4 * i);
  const double first = tool.ramp(3e-3, 0, kInstant, 10)[0];
  EXPECT_NEAR(first, kSpring * 1e-3, 1e-6);
}

/// Springs that a contact at the depth z holds with the weight 0.3 + 200 z.
class CoupledBranches : public ::testing::Test {
 protected:
  static double held(double z) { return kSpring * (0.3 + 200 * z); }  // N/m
  static Library body() {
    Library library = plate(8, 0.08, straight);
    library.kind = ResponseKind::Coupled;
    library.tool_radius = 0.02;  // all micro-slip stays within a tenth of it
    for (NodeResponse& node : library.responses) node.coupling = {0.3F, linear_curve(200)};
    return library;
  }
};

TEST_F(CoupledBranches, DragsAndHoldsAtADepthAreThoseOfMaxwellElements) {
  constexpr double kDrag = 1.5e-3, kDepth = 3e-3;
  for (const double time : {0.01, 0.3, 3.0}) {
    Dragged tool(body());
    const double rate = held(kDepth) * kDrag / time;  // N/s
    for (const double more : {0.0, 0.005, 0.2}) {
      double expected = kLongTerm * rate * time;
      for (const double tau : kTimes)
        expected += 0.25 * rate * tau * (1 - std::exp(-time / tau)) * std::exp(-more / tau);
      const Vec3 felt =
          more > 0 ? tool.hold(more == 0.2 ? 0.195 : more) : tool.ramp(kDrag, 0, time, 4000);
      EXPECT_NEAR(felt[0], expected, 1e-4 * rate * time) << time << " " << more;
    }
  }
}

TEST_F(CoupledBranches, AContactThatGrowsGoesOnToRelaxAndOneThatShrinksLosesAsMuchOfItsForce) {
  // A contact at 2 mm holds a drag. At 3 mm the force is the same: what has come into contact is
  // not sheared. At 1.7 mm it is that of the springs that are left. The relaxation goes on as it
  // was.
  Dragged tool(body());
  tool.press(2e-3);
  const double drag = 1e-3, first = tool.ramp(drag, 0, kInstant, 5)[0];
  EXPECT_NEAR(first, held(2e-3) * drag, 1e-6 * first);
  double time = 0;
  const auto expect = [&](double left) {
    EXPECT_NEAR(tool.lateral()[0], left * first * prony(time), 1e-6 * first) << time;
    for (const double dt : {0.01, 0.06}) {
      time += dt;
      EXPECT_NEAR(tool.hold(dt)[0], left * first * prony(time), 1e-6 * first) << time;
    }
  };
  expect(1);
  for (const double z : {2.2e-3, 3e-3}) tool.press(z);
  expect(1);
  // Back to where it was: the springs that came into contact let go what they bear by now.
  tool.press(2e-3);
  expect(held(2e-3) / held(3e-3));
  for (const double z : {1.9e-3, 1.7e-3}) tool.press(z);
  expect(held(1.7e-3) / held(3e-3));
}

TEST_F(CoupledBranches, ADragAfterTheContactHasGrownShearsAllThatIsHeld) {
  Dragged tool(body());
  tool.press(1e-3);
  tool.ramp(1e-3, 0, kInstant, 5);
  tool.hold(0.1);
  const double before = tool.lateral()[0];
  tool.press(3e-3);
  const Vec3 after = tool.ramp(1e-3, 4e-4, kInstant, 5);
  EXPECT_NEAR(after[0], before, 1e-6 * before);
  EXPECT_NEAR(after[1], held(3e-3) * 4e-4, 1e-6 * before);
}

TEST_F(CoupledBranches, WhatAGripLosesIsNotGivenBack) {
  // Springs that let go as the contact shrinks lose what they store: of V = g_inf w k q^2/2, after
  // all that relaxes has, the part 1 - w(z)/w(z_w).
  Dragged tool(body());
  const auto lost = [&] {
    const auto& seen = tool.seen();
    return seen.absorbed - seen.energy - seen.dissipated;
  };
  const double q = std::hypot(2e-3, 1e-3), deep = tool.depth();
  tool.ramp(2e-3, 1e-3, 0.2, 400);
  tool.hold(100);
  EXPECT_NEAR(lost(), 0, 1e-14);
  tool.press(2.7e-3);
  const double expected = kLongTerm * (held(deep) - held(2.7e-3)) * q * q / 2;
  EXPECT_NEAR(lost(), expected, 1e-6 * expected);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0, 1);
  double least = lost();
  for (int i = 0; i < 3000; ++i) {
    tool.press(4e-3 * any(random));
    tool.to(3e-3 * any(random), 3e-3 * any(random), 0.05 * any(random) * any(random));
    EXPECT_GE(lost(), least - 1e-15) << i;
    least = lost();
  }
  EXPECT_GT(least, 1e-5);
}

TEST(LateralBranches, TurnWithTheNormalAndKeepTheirEnergy) {
  const Library library = relaxing(plate(2, 0.08, stiffening), kTimes, true);
  const palpate_library body(library);
  const runtime::InterpolatedResponse response = body.surface.response({0, {0.2, 0.5, 0.3}});
  runtime::Lanes fractions, decay;
  for (const std::size_t i : {0U, 1U}) {
    fractions.set(i, 0.25);
    decay.set(i, i == 0 ? 0.1 : 0.7);
  }
  const Vec3 down{0, 0, -1}, aside{0.6, 0, -0.8};
  runtime::LateralBranches branches(2);
  const Vec3& weights = response.natural();
  const runtime::LateralPlace here{response, fractions, down, weights};
  const runtime::LateralPlace turned{response, fractions, aside, weights};
  branches.pass(here, {0.1, 0.05, 0}, 2e-3, decay);
  branches.settle(branches.find_stored(here));
  const runtime::LateralMemory before = branches.now();
  EXPECT_GT(before.stored(), 1e-7);
  branches.carry(turned, branches.carried_to(turned, 1), {});
  const runtime::LateralMemory after = branches.now();
  EXPECT_NEAR(dot(after.relaxed(), aside), 0, 1e-16);
  EXPECT_NEAR(norm(after.relaxed()), norm(before.relaxed()), 1e-16);
  EXPECT_NEAR(after.stored(), before.stored(), 1e-18);
  // The axis of the turn is y: the part along it stays.
  EXPECT_NEAR(after.relaxed()[1], before.relaxed()[1], 1e-16);
  EXPECT_FALSE(branches.carried_to({response, fractions, -aside, weights}, 1).any);
}

TEST(LateralBranches, AChangeThatIsChosenAfterOthersWereConsideredIsTheSame) {
  const Library library = relaxing(plate(2, 0.08, stiffening), kTimes, true);
  const palpate_library body(library);
  const runtime::InterpolatedResponse response = body.surface.response({0, {0.2, 0.5, 0.3}});
  const runtime::InterpolatedResponse other = body.surface.response({0, {0.6, 0.1, 0.3}});
  runtime::Lanes fractions, decay;
  for (const std::size_t i : {0U, 1U}) {
    fractions.set(i, 0.25);
    decay.set(i, i == 0 ? 0.1 : 0.7);
  }
  const Vec3 down{0, 0, -1}, aside{0.6, 0, -0.8}, across{0, 0.6, -0.8};
  const Vec3 narrow = 0.5 * response.natural(), wide = 0.8 * response.natural();
  const runtime::LateralPlace here{response, fractions, down, narrow};
  const runtime::LateralPlace slid{response, fractions, aside, narrow};
  const runtime::LateralPlace grown{response, fractions, aside, wide};
  const runtime::LateralPlace elsewhere{other, fractions, across, other.natural()};
  const auto carried = [&](bool considers_others, double held, bool grows) {
    runtime::LateralBranches branches(2);
    branches.pass(here, {0.1, 0.05, 0}, 4e-3, decay);
    branches.settle(branches.find_stored(here));
    runtime::LateralMemory chosen = branches.carried_to(slid, 0.9);
    chosen.held = held;  // the contact has shrunk there
    chosen.relaxed_xy *= held;
    chosen.relaxed_z *= held;
    if (grows) chosen = branches.held_at(grown, chosen);
    if (considers_others) branches.held_at(elsewhere, branches.carried_to(elsewhere, 0.3));
    const runtime::LateralPlace& end = grows ? grown : slid;
    branches.carry(end, chosen, narrow);
    // What the branches then are shows in what they store, and where they go on.
    return std::pair(branches.now().relaxed(),
                     std::pair(branches.find_stored(end), branches.carried_to(end, 0.5).relaxed()));
  };
  for (const bool grows : {false, true})
    for (const double held : {1.0, 0.6}) {
      const auto at_once = carried(false, held, grows), later = carried(true, held, grows);
      EXPECT_GT(norm(at_once.first), 0.01);
      EXPECT_GT(at_once.second.first, 1e-6);
      EXPECT_NEAR(norm(later.first - at_once.first), 0, 1e-15);
      EXPECT_NEAR(later.second.first, at_once.second.first, 1e-17);
      EXPECT_NEAR(norm(later.second.second - at_once.second.second), 0, 1e-15);
    }
}

}  // namespace
}  // namespace palpate::test
