// SPDX-License-Identifier: AGPL-3.0-or-later
// A contact from the first touch to the release, on bodies whose geometry is known.
#include "runtime/contact_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "runtime/handles.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::ContactSettings;
using runtime::ContactState;

/// The stored knots are single precision, so this agrees to 1e-7 N.
double wall_force(double z) {
  return z <= 0 ? 0 : z <= 0.005 ? 100 * 170 * z * z : 170 * (z - 0.0025);
}

/// A body and a tip on it.
struct Rig {
  explicit Rig(const Library& library, const ContactSettings& settings = {0.3, 5e-3})
      : body(library), contact(body.surface, body.tree, settings) {}
  std::uint32_t step(const Vec3& x) { return contact.step(x); }
  const runtime::ContactObservation& seen() const { return contact.observation(); }
  palpate_library body;
  ContactState contact;
};

Vec3 random_unit(std::mt19937& random) {
  std::normal_distribution<double> any;
  const Vec3 v{any(random), any(random), any(random)};
  return (1.0 / norm(v)) * v;
}

/// A suspended tip finds anew whether it is inside, wherever the origin is.
TEST(Contact, GoesOnAfterASuspensionInsideABodyFarFromTheOriginAndNotAboveIt) {
  for (const double height : {-1.0, 0.0, 1.0}) {
    Library library = plate(8, 0.1, uniform);
    for (Vec3& x : library.positions) x[2] += height;
    Rig rig(library);
    const Vec3 above{0.041, 0.052, height + 0.002}, below{0.041, 0.052, height - 0.002};
    rig.contact.suspend(above);
    EXPECT_EQ(rig.step(above - Vec3{0, 0, 0.0005}), 0U) << height;
    rig.contact.suspend(below);
    EXPECT_EQ(rig.step(below - Vec3{0, 0, 0.0005}), PALPATE_CONTACT | PALPATE_ACTIVATED) << height;
  }
}

TEST(Contact, BeginsWithoutForceOrEnergyAndWithAnOffsetOfAtMostOneStep) {
  Rig rig(bumpy_sphere(3, 0.03, 0.2, uniform));
  std::mt19937 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 out = random_unit(random);
    const double travel = 1e-3 * (1 + trial % 10) / 10;  // v T
    rig.contact.reset();
    std::uint32_t status = 0;
    for (double r = 0.04 + 1e-6 * trial; !(status & PALPATE_ACTIVATED); r -= travel) {
      ASSERT_GT(r, 0.015) << "fell through";
      status = rig.step(r * out);
      EXPECT_TRUE(status == 0 || status & PALPATE_ACTIVATED);
    }
    EXPECT_EQ(status, PALPATE_CONTACT | PALPATE_ACTIVATED);
    EXPECT_LE(norm(rig.seen().force), 1e-8);
    EXPECT_LE(rig.seen().energy, 1e-18);
    EXPECT_GE(rig.seen().offset, 0);
    EXPECT_LE(rig.seen().offset, travel);
  }
}

TEST(Contact, PressingAtANodeGivesTheCurveOfTheNode) {
  // Every node has its own stiffness; press radially on each.
  const Responses own = [](const Vec3& x) {
    return wall_response(170 * (1 + 0.5 * std::sin(200 * x[0] + 150 * x[1])), 100);
  };
  const Library library = sphere(2, 0.03, own);
  Rig rig(library);
  for (std::size_t v = 0; v < library.positions.size(); ++v) {
    const Vec3 x0 = library.positions[v];
    const Vec3 n = library.inward[v];
    rig.contact.reset();
    rig.step(x0 - 1e-4 * n);
    rig.step(x0 + 1e-9 * n);
    const runtime::CompiledCurve curve(own(x0).normal);
    for (int i = 1; i <= 80; ++i) {
      rig.step(x0 + 1e-4 * i * n);
      const Vec3 expected = curve.force(1e-4 * i - rig.seen().offset) * n;
      ASSERT_NEAR(norm(rig.seen().force - expected), 0, 1e-9);
    }
  }
}

TEST(Contact, SlidingAtConstantDepthObeysAmontons) {
  for (const double mu : {0.05, 0.1, 0.3, 0.6}) {
    Rig rig(plate(10, 0.1, uniform), {mu, 5e-3});
    rig.step({0.02, 0.031, 0.0001});
    for (int i = 1; i <= 40; ++i) rig.step({0.02, 0.031, -1e-4 * i});
    int sliding = 0;
    for (int i = 1; i <= 5000; ++i) {  // a slow spiral over many triangles
      const double a = 0.002 * i;
      rig.step({0.02 + 1e-5 * i, 0.031 + 0.01 * std::sin(a), -0.004});
      if (!(rig.seen().status & PALPATE_SLIDING)) continue;
      ++sliding;
      const auto f = rig.seen().force;
      ASSERT_NEAR(std::hypot(f[0], f[1]), mu * -f[2], 1e-9);
    }
    EXPECT_GT(sliding, 4000);
  }
}

TEST(Contact, ForceIsContinuousWhileSlidingOverEdges) {
  // On curved bodies with responses that differ from node to node, ten times smaller steps must
  // give about ten times smaller changes of force: no jump hides at an edge.
  const Responses varied = [](const Vec3& x) {
    return wall_response(170 * (1 + 0.6 * std::sin(150 * x[2])),
                         100 * (1 + 0.4 * std::sin(90 * x[0])));
  };
  const auto largest_change = [&](int steps) {
    Rig rig(sphere(3, 0.03, varied), {0.2, 5e-3});
    rig.step({0.031, 0, 0});
    double largest = 0;
    for (int i = 1; i <= steps; ++i) rig.step({0.031 - 0.005 * i / steps, 0, 0});
    Vec3 before = rig.seen().force;
    for (int i = 1; i <= 10 * steps; ++i) {
      const double a = 2.0 * i / (10 * steps);
      rig.step(0.026 * Vec3{std::cos(a), std::sin(a) * 0.8, std::sin(a) * 0.6});
      largest = std::max(largest, norm(rig.seen().force - before));
      before = rig.seen().force;
    }
    EXPECT_GT(norm(before), 0.1);
    return largest;
  };
  const double coarse = largest_change(200);
  const double fine = largest_change(2000);
  EXPECT_LT(fine, 0.15 * coarse);
  EXPECT_LT(coarse, 0.01);
}

/// Friction in closed form on a plate of equal linear springs: the anchor plays in a disc of radius
/// rho_s about the tip.
class Anchor {
 public:
  Anchor(const Vec3& start, double limit) : a_(start), limit_(limit) {}
  void follow(const Vec3& x) {
    const Vec3 q{x[0] - a_[0], x[1] - a_[1], 0};
    const double rho = norm(q);
    if (rho > limit_) a_ = a_ + ((rho - limit_) / rho) * q;
  }
  const Vec3& place() const { return a_; }

 private:
  Vec3 a_;
  double limit_;
};

constexpr double kLateral = 100, kMu = 0.3, kDepth = 0.004;

/// Presses at a place of the plate of 0.1 m, 4 mm deep. Returns g, N.
double press(Rig& rig, const Vec3& at) {
  rig.step(at + Vec3{0, 0, 1e-4});
  for (int i = 1; i <= 40; ++i) rig.step(at - Vec3{0, 0, 1e-4 * i});
  return wall_force(kDepth - rig.seen().offset);
}

TEST(Contact, BeyondABorderTheToolFeelsFrictionAndNoMore) {
  // In and out over rims and corners: c is the point of the plate nearest to the anchor, and the
  // lateral force is that of friction everywhere.
  Rig rig(plate(10, 0.1, uniform));
  const Vec3 start{0.09, 0.05, 0};
  const double g = press(rig, start);
  Anchor anchor(start, kMu * g / kLateral);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-0.02, 0.12);
  Vec3 x = start - Vec3{0, 0, kDepth};
  int beyond = 0, slipping = 0;
  for (int leg = 0; leg < 60; ++leg) {
    const Vec3 step = (1.0 / 200) * (Vec3{place(random), place(random), -kDepth} - x);
    for (int i = 0; i < 200; ++i) {
      x = x + step;
      const std::uint32_t status = rig.step(x);
      anchor.follow(x);
      const Vec3& a = anchor.place();
      const Vec3 nearest{std::clamp(a[0], 0.0, 0.1), std::clamp(a[1], 0.0, 0.1), 0};
      ASSERT_NEAR(norm(rig.seen().contact_point - nearest), 0, 1e-10);
      ASSERT_NEAR(norm(rig.seen().lateral_offset - (a - nearest)), 0, 1e-10);
      const Vec3 lateral = kLateral * Vec3{x[0] - a[0], x[1] - a[1], 0};
      ASSERT_NEAR(norm(rig.seen().force - lateral - Vec3{0, 0, -g}), 0, 1e-7);
      ASSERT_LE(norm(rig.seen().force + Vec3{0, 0, g}), kMu * g + 1e-7);
      if (norm(a - nearest) <= 0) continue;
      EXPECT_TRUE(status & PALPATE_AT_BORDER);
      ++beyond;
      slipping += norm(lateral) > 0.999 * kMu * g ? 1 : 0;
    }
  }
  EXPECT_GT(beyond, 2000);
  EXPECT_GT(slipping, 1000);
}

TEST(Contact, SlippingBeyondABorderCostsWhatFrictionTakes) {
  Rig rig(plate(10, 0.1, uniform));
  const double g = press(rig, {0.09, 0.05, 0});
  for (int i = 1; i <= 400; ++i) rig.step({0.09 + 5e-5 * i, 0.05, -kDepth});
  EXPECT_EQ(rig.seen().contact_point[0], 0.1);
  const double before = rig.seen().absorbed;
  const double travel = 5e-5;
  for (int i = 1; i <= 200; ++i) rig.step({0.11 + travel * i, 0.05, -kDepth});
  // Within a step the model is held: its force goes on rising from mu g, by k travel / 2 on
  // average.
  EXPECT_NEAR(rig.seen().absorbed - before, (kMu * g + kLateral * travel / 2) * 200 * travel,
              1e-10);
  // Lifted off there nothing is stored any more: no energy is discarded.
  std::uint32_t status = 0;
  for (int i = 1; i <= 45; ++i) status |= rig.step({0.12, 0.05, -kDepth + 1e-4 * i});
  EXPECT_TRUE(status & PALPATE_RELEASED);
  EXPECT_FALSE(status & PALPATE_DROPPED);
  EXPECT_EQ(norm(rig.seen().force), 0);
}

TEST(Contact, AThinBodyKeepsTheSideOfEntry) {
  Rig rig(thin_body(10, 0.1, 0.002, uniform));
  rig.step({0.05, 0.05, 0.001});
  for (int i = 0; i <= 60; ++i) {  // through the far side and 4 mm beyond
    rig.step({0.05, 0.05, 0.0005 - 1e-4 * i});
    EXPECT_LE(rig.seen().force[2], 0) << "pushed out on the far side";
  }
  EXPECT_GT(rig.seen().deflection.depth, 0.005);
  EXPECT_NEAR(-rig.seen().force[2], wall_force(rig.seen().deflection.depth), 1e-7);
  for (int i = 0; i <= 70; ++i) rig.step({0.05, 0.05, -0.0055 + 1e-4 * i});
  EXPECT_EQ(rig.seen().status & PALPATE_CONTACT, 0U);
  // From below, the other side answers.
  Rig below(thin_body(10, 0.1, 0.002, uniform));
  for (int i = 0; i <= 40; ++i) below.step({0.05, 0.05, -0.003 + 1e-4 * i});
  EXPECT_GT(below.seen().force[2], 0.01);
}

TEST(Contact, TheOffsetIsGivenBackWhenTheTipReturnsTowardsTheSurface) {
  Rig rig(plate(10, 0.1, uniform));
  rig.step({0.05, 0.05, 0.0005});
  rig.step({0.05, 0.05, -0.0005});
  EXPECT_NEAR(rig.seen().offset, 0.0005, 1e-15);
  rig.step({0.05, 0.05, -0.0002});  // still inside: the true surface is nearer again
  EXPECT_NEAR(rig.seen().offset, 0.0002, 1e-15);
  EXPECT_EQ(rig.seen().energy, 0);
  rig.step({0.05, 0.05, -0.003});
  EXPECT_NEAR(-rig.seen().force[2], wall_force(0.0028), 1e-7);
}

TEST(Contact, AContactIsFollowedWithoutForceUntilItCanBegin) {
  // Entering by a slanted step close to the rim: no point of the plate faces the tip, which ends up
  // beyond it. No force, no contact; back over the plate it begins, at zero energy.
  Rig rig(plate(10, 0.1, uniform));
  rig.step({0.0995, 0.05, 0.0002});
  EXPECT_EQ(rig.step({0.1005, 0.05, -0.0003}) & ~std::uint32_t{PALPATE_AT_BORDER}, 0U);
  EXPECT_EQ(norm(rig.seen().force), 0);
  const std::uint32_t status = rig.step({0.099, 0.05, -0.0003});
  EXPECT_TRUE(status & PALPATE_ACTIVATED);
  EXPECT_LE(rig.seen().energy, 1e-18);
}

TEST(Contact, BeyondTheDeepestSampleIsReported) {
  Rig rig(plate(10, 0.1, uniform));
  rig.step({0.05, 0.05, 0.0001});
  for (int i = 1; i <= 190; ++i)
    EXPECT_FALSE(rig.step({0.05, 0.05, -1e-4 * i}) & PALPATE_BEYOND_DEPTH);
  for (int i = 210; i <= 300; ++i)
    EXPECT_TRUE(rig.step({0.05, 0.05, -1e-4 * i}) & PALPATE_BEYOND_DEPTH);
  EXPECT_NEAR(-rig.seen().force[2], wall_force(rig.seen().deflection.depth), 1e-6);
}

TEST(Contact, AHoleLetsTheTipThrough) {
  Library library = plate(10, 0.1, uniform);
  library.responses[5 * 11 + 5] = {};
  Rig rig(library);
  rig.step({0.051, 0.052, 0.0005});
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(rig.step({0.051, 0.052, -1e-4 * i}), 0U);
    EXPECT_EQ(norm(rig.seen().force), 0);
  }
}

TEST(Contact, TheForceChangesNoFasterThanTheLipschitzBoundUntilItHasGone) {
  // Lifted while slipping, the force of a plate of springs k falls by sqrt(1 + mu^2) k for each
  // metre. Held to k, the lateral part lags behind, follows, and still ends in a proper release.
  const double k = 170;
  const double mu = 0.6;
  const double unlimited = std::sqrt(1 + mu * mu) * k;
  for (const double lipschitz_bound : {k, 1.001 * unlimited}) {
    Rig rig(plate(10, 0.1, [&](const Vec3&) { return wall_response(k, k); }),
            {mu, 5e-3, runtime::EnergyBudget::Enforced, lipschitz_bound});
    rig.step({0.02, 0.03, 0.0001});
    for (int i = 0; i <= 140; ++i) rig.step({0.02, 0.03, -5e-5 * i});
    for (int i = 0; i <= 500; ++i) rig.step({0.02 + 2e-5 * i, 0.03, -0.007});
    std::uint32_t status = 0;
    double steepest = 0;
    for (int i = 1; i <= 1200; ++i) {
      const Vec3 before = rig.seen().force;
      status |= rig.step({0.03, 0.03, -0.007 + 1e-5 * i});
      steepest = std::max(steepest, norm(rig.seen().force - before) / 1e-5);
    }
    EXPECT_LE(steepest, lipschitz_bound * (1 + 1e-6));
    EXPECT_GT(steepest, 0.98 * std::min(lipschitz_bound, unlimited));
    EXPECT_EQ((status & PALPATE_FORCE_LIMITED) != 0, lipschitz_bound < unlimited);
    EXPECT_EQ(norm(rig.seen().force), 0);
    EXPECT_TRUE(status & PALPATE_RELEASED);
    EXPECT_FALSE(status & PALPATE_DROPPED);
  }
}

TEST(Contact, ASlideThatTheLimitHoldsBackIsFeltAsFrictionAndMadeUpFor) {
  // Over a seam beyond which the body is four times as stiff: c may not follow all at once, the
  // tool slips ahead of it, and c is with the anchor again soon after.
  const Responses seam = [](const Vec3& x) {
    return x[0] < 0.05 ? wall_response(40, 100) : wall_response(160, 100);
  };
  const double lipschitz_bound = 160;
  for (const double step : {1e-5, 1e-4, 4e-4}) {
    Rig rig(plate(200, 0.1, seam), {kMu, 5e-3, runtime::EnergyBudget::Enforced, lipschitz_bound});
    rig.step({0.03, 0.05, 1e-4});
    for (int i = 0; i <= 50; ++i) rig.step({0.03, 0.05, -1e-4 * i});
    double furthest = 0;
    std::uint32_t status = 0;
    for (double way = 0; way < 0.04; way += step) {
      const Vec3 before = rig.seen().force;
      status |= rig.step({0.03 + way, 0.05, -0.005});
      const Vec3 f = rig.seen().force;
      ASSERT_LE(norm(f - before), lipschitz_bound * step + 1e-9);
      ASSERT_LE(f[0], kMu * -f[2] + (1 + kMu) * lipschitz_bound * step);
      furthest = std::max(furthest, norm(rig.seen().lateral_offset));
    }
    EXPECT_TRUE(status & PALPATE_FORCE_LIMITED) << step;
    EXPECT_GT(furthest, step) << step;
    EXPECT_EQ(norm(rig.seen().lateral_offset), 0) << step;
    EXPECT_NEAR(rig.seen().force[0], kMu * -rig.seen().force[2], 1e-9) << step;
  }
}

TEST(Contact, WithoutALimitTheSlideGoesOnUnderATipAtRest) {
  // No travel and no limit: infinity times zero must not pass for a limit of nothing.
  Rig rig(sphere(2, 0.03, uniform), {0.1, 5e-3});
  rig.step({0.031, 0, 0});
  for (int i = 0; i <= 40; ++i) rig.step({0.03 - 1e-4 * i, 0, 0});
  rig.step({0.025, 0.004, 0});  // a slide that one step does not finish on a curved surface
  for (int i = 0; i < 50; ++i) rig.step({0.025, 0.004, 0});
  const runtime::LocalModel model(rig.body.surface, rig.seen().point, rig.seen().offset);
  EXPECT_NEAR(rig.seen().deflection.lateral, model.slip_limit(rig.seen().deflection, 0.1), 1e-9);
  EXPECT_FALSE(rig.seen().status & PALPATE_FORCE_LIMITED);
}

/// Solid angle of the closed surface seen from x, over 4 pi: 1 inside, 0 outside.
double winding(const Library& body, const Vec3& x) {
  double sum = 0;
  for (const Triangle& t : body.triangles) {
    const Vec3 a = body.positions[static_cast<std::size_t>(t[0])] - x;
    const Vec3 b = body.positions[static_cast<std::size_t>(t[1])] - x;
    const Vec3 c = body.positions[static_cast<std::size_t>(t[2])] - x;
    const double la = norm(a);
    const double lb = norm(b);
    const double lc = norm(c);
    sum += 2 * std::atan2(dot(a, cross(b, c)),
                          la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::acos(-1.0));
}

TEST(Contact, NeverLosesATipThatIsInsideTheBody) {
  // Random flights in and out over hills and valleys; inside by the winding number means contact.
  const Library library = bumpy_sphere(2, 0.03, 0.35, uniform);
  for (const double mu : {0.0, 0.3}) {
    Rig rig(library, {mu, 5e-3});
    std::mt19937 random(9);
    std::uniform_real_distribution<double> any(-1, 1);
    Vec3 x = 0.045 * random_unit(random);
    Vec3 towards = x;
    int inside = 0;
    int lost = 0;
    for (int i = 0; i < 40000; ++i) {
      if (i % 60 == 0) towards = (0.034 + 0.012 * any(random)) * random_unit(random);
      x = x + 0.03 * (towards - x);
      rig.step(x);
      if (i % 3 != 0 || winding(library, x) < 0.5) continue;
      ++inside;
      lost += rig.seen().status & PALPATE_CONTACT ? 0 : 1;
    }
    EXPECT_GT(inside, 2000);
    EXPECT_EQ(lost, 0) << "mu = " << mu;
  }
}

TEST(Contact, TheForceOfEveryStepIsThatOfTheStateItLeaves) {
  // The step carries pieces, deflections and slip limits over from one evaluation to the next; what
  // it reports must be what nobody's memory gives at its contact point and offsets.
  const Library decoupled = bumpy_sphere(3, 0.03, 0.2, uneven);
  for (const Library& library : {decoupled, coupled(decoupled)}) {
    Rig rig(library, {.friction = 0.3, .tank_cap = 1e-4, .lipschitz_bound = 4 * kSteepestUneven});
    std::mt19937 random(11);
    std::normal_distribution<double> any;
    Vec3 x = 0.04 * random_unit(random);
    Vec3 way{};
    int in_contact = 0, sliding = 0;
    for (int step = 0; step < 200000; ++step) {
      const double r = norm(x);
      way = 0.97 * way + 2e-5 * Vec3{any(random), any(random), any(random)} -
            (2e-4 * (r - 0.028)) * ((1 / r) * x);
      x = x + way;
      const std::uint32_t status = rig.step(x);
      if (!(status & PALPATE_CONTACT)) continue;
      ++in_contact;
      sliding += (status & PALPATE_SLIDING) != 0;
      const runtime::ContactObservation& seen = rig.seen();
      runtime::LocalModel model(rig.body.surface, seen.point, seen.offset);
      model.set_grip(seen.grip);
      model.set_lateral_offset(seen.lateral_offset);
      const runtime::LocalResponse want = model.respond(model.deflection(x));
      ASSERT_NEAR(norm(seen.force - want.force), 0, 1e-12 * (norm(want.force) + 1e-3));
      ASSERT_NEAR(seen.energy, want.energy, 1e-12 * want.energy + 1e-18);
    }
    EXPECT_GT(in_contact, 50000);
    EXPECT_GT(sliding, 10000);
  }
}

}  // namespace
}  // namespace palpate::test
