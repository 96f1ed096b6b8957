// SPDX-License-Identifier: AGPL-3.0-or-later
// Coupled responses: the lateral response is that of the contact as wide as it is. It is
// conservative while the contact holds, and what comes into contact holds tissue without stress.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "runtime/local_model.hpp"
#include "runtime/sliding.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::Deflection;
using runtime::LocalModel;
using runtime::LocalResponse;
using runtime::Surface;
using runtime::SurfacePoint;

class Coupled : public ::testing::Test {
 protected:
  SurfacePoint random_point() {
    const Vec3 n{between(0.02, 1), between(0.02, 1), between(0.02, 1)};
    const auto count = static_cast<unsigned>(surface_.element_count());
    return {static_cast<std::int32_t>(random_() % count), (1.0 / (n[0] + n[1] + n[2])) * n};
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 tip(const LocalModel& model, double z, double rho) {
    const Vec3 n = model.normal();
    Vec3 side{between(-1, 1), between(-1, 1), between(-1, 1)};
    side = side - dot(side, n) * n;
    return model.contact_point() + (z + model.offset()) * n + (rho / norm(side)) * side;
  }
  static LocalResponse at(const LocalModel& model, const Vec3& x) {
    return model.respond(model.deflection(x));
  }
  /// A model that holds the depth z.
  LocalModel holding(double offset, double z) {
    LocalModel model(surface_, random_point(), offset);
    model.set_grip({z, {}});
    return model;
  }

  const Library library_ = coupled(bumpy_sphere(2, 0.03, 0.2, uneven));
  const Surface surface_{library_};
  std::mt19937 random_{7};
};

TEST_F(Coupled, ForceIsTheGradientOfTheEnergy) {
  const double h = 1e-7;
  for (int trial = 0; trial < 300; ++trial) {
    const LocalModel model = holding(0.0004, between(0, 0.008));
    const Vec3 x = tip(model, between(0.0001, 0.007), between(0.0002, 0.005));
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3 up = x, down = x;
      up[i] += h;
      down[i] -= h;
      EXPECT_NEAR((at(model, up).energy - at(model, down).energy) / (2 * h), at(model, x).force[i],
                  1e-6);
    }
  }
}

TEST_F(Coupled, ForceOpposesTheDeflectionAndTheEnergyIsNeverNegative) {
  for (int trial = 0; trial < 3000; ++trial) {
    const LocalModel model = holding(0, between(0, 0.008));
    const double z = between(-0.003, 0.009), rho = between(0, 0.01);
    const LocalResponse r = at(model, tip(model, z, rho));
    EXPECT_GE(r.energy, 0);
    EXPECT_GE(r.lateral_force, 0);
    EXPECT_EQ(r.normal_force, r.friction_normal_force);
    if (z <= 0) {
      EXPECT_EQ(r.normal_force, 0);
    }
  }
  const LocalModel model(surface_, random_point(), 0);
  EXPECT_EQ(at(model, model.contact_point()).energy, 0);
}

TEST_F(Coupled, ForceIsContinuousWhereTheToolLeaves) {
  for (int trial = 0; trial < 100; ++trial) {
    const LocalModel model(surface_, random_point(), 0);
    const Vec3 x = tip(model, 0, between(0.001, 0.005));
    const double step = 1e-9;
    const Vec3 jump =
        at(model, x + step * model.normal()).force - at(model, x - step * model.normal()).force;
    EXPECT_LT(norm(jump), 2e-6);  // 2 nm at less than 1000 N/m
  }
}

TEST_F(Coupled, SlipBeginsWhereTheLateralForceIsMuTimesTheGrip) {
  for (int trial = 0; trial < 500; ++trial) {
    const double z = between(0.0001, 0.007);
    const double mu = between(0.05, 1);
    const LocalModel model = holding(0, z);
    const Deflection there = model.deflection(tip(model, z, 0.02));
    const double limit = model.slip_limit(there, mu);
    const LocalResponse r = at(model, tip(model, z, limit));
    EXPECT_NEAR(r.lateral_force, mu * r.friction_normal_force, 1e-9);
    runtime::ToolPieces pieces;
    const LocalResponse pressed = model.respond(there, pieces);
    const double force = mu * pressed.friction_normal_force;
    EXPECT_NEAR(model.lateral_below(there, force, pieces), limit, 1e-12);
  }
}

TEST_F(Coupled, EnergySlopeAlongTheSurface) {
  for (int trial = 0; trial < 300; ++trial) {
    const SurfacePoint p = random_point();
    LocalModel model(surface_, p, 0.0003);
    const double held = between(0, 0.006);
    model.set_grip({held, {}});
    const Vec3 x = tip(model, between(0.0005, 0.006), between(0.0005, 0.004));
    const Deflection d = model.deflection(x);
    const runtime::Element& e = surface_.element(p.element);
    Vec3 along = d.tangent - dot(d.tangent, e.facet_normal) * e.facet_normal;
    along = (1 / norm(along)) * along;
    const double h = 1e-7;
    const auto energy = [&](double s) {
      SurfacePoint moved = p;
      for (std::size_t l = 0; l < 3; ++l) moved.natural[l] += s * dot(e.gradient[l], along);
      LocalModel there(surface_, moved, 0.0003);
      there.set_grip({held, {}});
      return at(there, x).energy;
    };
    EXPECT_NEAR(model.energy_slope(d, along), (energy(h) - energy(-h)) / (2 * h), 1e-6);
  }
}

TEST_F(Coupled, WithAWeightOfOneIsTheDecoupledResponse) {
  Library plain = library_;
  plain.kind = ResponseKind::Decoupled;
  Library flat = library_;
  for (NodeResponse& node : flat.responses) node.coupling = {1.0F, {{0.0F, 0.01F}, {0.0F, 0.0F}}};
  const Surface expected(plain), surface(flat);
  for (int trial = 0; trial < 300; ++trial) {
    const SurfacePoint p = random_point();
    const LocalModel a(expected, p, 0.0002), b(surface, p, 0.0002);
    const Vec3 x = tip(a, between(-0.001, 0.008), between(0, 0.006));
    EXPECT_LT(norm(at(a, x).force - at(b, x).force), 1e-12);
    EXPECT_NEAR(at(a, x).energy, at(b, x).energy, 1e-15);
    EXPECT_NEAR(a.slip_limit(a.deflection(x), 0.3), b.slip_limit(b.deflection(x), 0.3), 1e-12);
  }
}

TEST_F(Coupled, AContactThatGrowsKeepsTheLateralForceAndOneThatShrinksLosesIt) {
  // Linear lateral springs: w(z) k |q|. A growing contact keeps the force, so that q falls as 1/w;
  // one that shrinks keeps q.
  Library library = plate(2, 0.04, [](const Vec3&) { return wall_response(170, 120); });
  library.kind = ResponseKind::Coupled;
  library.tool_radius = 0.05;
  for (NodeResponse& node : library.responses) node.coupling = {0.5F, linear_curve(200)};
  const Surface surface(library);
  const auto w = [](double z) { return 0.5 + 200 * z; };
  for (int trial = 0; trial < 200; ++trial) {
    LocalModel model(surface, {static_cast<std::int32_t>(random_() % 8), {0.2, 0.5, 0.3}}, 0);
    const double held = between(0.0005, 0.005), z = between(0.0005, 0.005);
    const double rho = between(0.0002, 0.004);
    model.set_grip({held, {}});
    const Vec3 x = tip(model, z, rho);
    Deflection d = model.deflection(x);
    runtime::ToolPieces pieces;
    LocalResponse r = model.respond(d, pieces);
    const double before = r.energy, force = r.lateral_force;
    EXPECT_NEAR(force, w(held) * 120 * rho, 1e-6 * force);
    model.renew_grip(d, r, pieces);
    EXPECT_EQ(model.grip().depth, d.depth);
    EXPECT_LE(r.energy, before);
    const double stays = std::min(1.0, w(z) / w(held));
    EXPECT_NEAR(r.lateral_force, stays * force, 1e-6 * force);
    EXPECT_NEAR(r.normal_force, at(model, x).normal_force, 1e-15);
    EXPECT_NEAR(norm(model.grip().micro_slip), z > held ? rho * (1 - w(held) / w(z)) : 0,
                1e-6 * rho);
    // What the tip has moved is what it was, and the model at x is that of the deflection.
    EXPECT_NEAR(norm(model.lateral_displacement(d)), rho, 1e-12);
    EXPECT_NEAR(norm(at(model, x).force - r.force), 0, 1e-9);
    EXPECT_NEAR(at(model, x).energy, r.energy, 1e-12);
  }
}

TEST_F(Coupled, MicroSlipBeyondATenthOfTheToolsRadiusGoesIntoTheLateralOffset) {
  int crept = 0;
  for (int trial = 0; trial < 300; ++trial) {
    LocalModel model = holding(0, 0.0002);
    const Vec3 x = tip(model, 0.006, 0.004);
    Deflection d = model.deflection(x);
    runtime::ToolPieces pieces;
    LocalResponse r = model.respond(d, pieces);
    const double force = r.lateral_force, before = r.energy;
    model.renew_grip(d, r, pieces);
    EXPECT_LE(r.energy, before);
    if (model.grip().depth != d.depth) continue;  // the energy would have risen
    ++crept;
    EXPECT_NEAR(norm(model.grip().micro_slip), 0.1 * library_.tool_radius, 1e-12);
    EXPECT_GT(norm(model.lateral_offset()), 0);
    EXPECT_NEAR(r.lateral_force, force, 1e-9);
    EXPECT_NEAR(norm(at(model, x).force - r.force), 0, 1e-9);
  }
  EXPECT_GT(crept, 100);
}

/// Springs whose lateral ones, w k, are tilted by w sigma, w = a + b z.
class TiltedPlate : public Coupled {
 protected:
  static constexpr double kBase = 0.3, kGrowth = 150, kShear = 120;  // 1, 1/m, N/m
  static constexpr Vec3 kLean{0.15, -0.08, 0};

  static Library tilted() {
    Library library = plate(2, 0.04, [](const Vec3&) { return wall_response(170, kShear); });
    library.kind = ResponseKind::Coupled;
    library.tool_radius = 0.05;
    const auto growth = static_cast<float>(kGrowth);
    for (NodeResponse& node : library.responses) {
      node.coupling = {static_cast<float>(kBase), {{0, 0.006F, 0.008F}, {growth, growth, 0}}};
      node.lean = {static_cast<float>(kLean[0]), static_cast<float>(kLean[1]), 0};
    }
    return library;
  }
  static double w(double z) { return kBase + kGrowth * z; }
  /// The integral of w^2 up to z.
  static double squares(double z) {
    return (std::pow(w(z), 3) - std::pow(kBase, 3)) / (3 * kGrowth);
  }
  /// Moves the tip along the normal to a depth in small steps.
  static LocalResponse press(LocalModel& model, double from, double to, int steps) {
    runtime::ToolPieces pieces;
    LocalResponse r;
    for (int k = 1; k <= steps; ++k) {
      const double z = from + (to - from) * k / steps;
      Deflection d = model.deflection(model.contact_point() + z * model.normal());
      r = model.respond(d, pieces);
      model.renew_grip(d, r, pieces);
    }
    return r;
  }

  const Surface tilted_{tilted()};
};

TEST_F(TiltedPlate, APressShearsByALeanThatGrowsWithTheContact) {
  // d(w q) = -w^2 sigma dz, as what comes into contact is not sheared.
  for (const double z : {0.001, 0.003, 0.0055}) {
    LocalModel model(tilted_, {3, {0.2, 0.5, 0.3}}, 0);
    const LocalResponse r = press(model, 0, z, 4000);
    const Vec3 n = model.normal(), lateral = -kShear * squares(z) * kLean;
    const double normal = r.normal_force - w(z) * dot(lateral, kLean);
    EXPECT_LT(norm(r.force - normal * n - lateral), 1e-3 * norm(lateral));
  }
}

TEST_F(TiltedPlate, ARetreatLosesTheLeanAsThePressGainedIt) {
  // d q = -w sigma dz on the way back: what lets go takes no shear with it.
  LocalModel model(tilted_, {3, {0.2, 0.5, 0.3}}, 0);
  press(model, 0, 0.005, 4000);
  const LocalResponse r = press(model, 0.005, 0.004, 1000);
  const auto integral = [](double z) { return kBase * z + 0.5 * kGrowth * z * z; };
  const double sheared = squares(0.005) / w(0.005) - (integral(0.005) - integral(0.004));
  const Vec3 n = model.normal(), lateral = -kShear * w(0.004) * sheared * kLean;
  EXPECT_LT(norm(r.force - dot(r.force, n) * n - lateral), 1e-3 * norm(lateral));
  EXPECT_NEAR(dot(r.force, n), r.normal_force - w(0.004) * dot(lateral, kLean), 1e-4);
}

TEST_F(TiltedPlate, ANewLeanTakesNothingFromTheLateralDeflection) {
  for (int trial = 0; trial < 100; ++trial) {
    LocalModel model(tilted_, {3, {0.2, 0.5, 0.3}}, 0);
    const double held = between(0.0005, 0.0055), z = between(0.0005, 0.0055);
    model.set_grip({held, {}});
    const Vec3 x = tip(model, z, between(0.0002, 0.002));
    Deflection d = model.deflection(x);
    runtime::ToolPieces pieces;
    LocalResponse r = model.respond(d, pieces);
    const double before = r.energy;
    const Vec3 q = d.lateral * d.tangent;
    model.renew_grip(d, r, pieces);
    if (z < held) {  // what lets go takes no shear with it
      EXPECT_LT(norm(d.lateral * d.tangent - q), 1e-15);
    }
    EXPECT_LE(r.energy, before);
    // The model at x is that of the deflection: nothing of the shear is lost.
    EXPECT_LT(norm(at(model, x).force - r.force), 1e-12);
    EXPECT_NEAR(at(model, x).energy, r.energy, 1e-15);
  }
}

TEST_F(Coupled, RefusesAWeightThatStartsAtNothing) {
  Library broken = library_;
  broken.responses[3].coupling.base = 0;
  EXPECT_ANY_THROW(Surface{broken});
  broken.responses[3].coupling.base = 0.1F;
  broken.responses[3].coupling.curve.slope[1] = -1;
  EXPECT_ANY_THROW(Surface{broken});
}

}  // namespace
}  // namespace palpate::test
