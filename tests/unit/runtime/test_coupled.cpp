// SPDX-License-Identifier: AGPL-3.0-or-later
// Coupled responses: one potential E(z, rho) at each contact point, the force its gradient.
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

  const Library library_ = coupled(bumpy_sphere(2, 0.03, 0.2, uneven));
  const Surface surface_{library_};
  std::mt19937 random_{7};
};

TEST_F(Coupled, ForceIsTheGradientOfTheEnergy) {
  const double h = 1e-7;
  for (int trial = 0; trial < 300; ++trial) {
    const LocalModel model(surface_, random_point(), 0.0004);
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
    const LocalModel model(surface_, random_point(), 0);
    const double z = between(-0.003, 0.009), rho = between(0, 0.01);
    const LocalResponse r = at(model, tip(model, z, rho));
    EXPECT_GE(r.energy, 0);
    EXPECT_GE(r.lateral_force, 0);
    EXPECT_GE(r.normal_force, r.friction_normal_force);
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
    const LocalModel model(surface_, random_point(), 0);
    const double z = between(0.0001, 0.007);
    const double mu = between(0.05, 1);
    const Deflection there = model.deflection(tip(model, z, 0.02));
    const double limit = model.slip_limit(there, mu);
    const LocalResponse r = at(model, tip(model, z, limit));
    EXPECT_NEAR(r.lateral_force, mu * r.friction_normal_force, 1e-9);
    runtime::ToolPieces pieces;
    const LocalResponse pressed = model.respond(there, pieces);
    const double force = mu * pressed.friction_normal_force;
    EXPECT_NEAR(model.lateral_below(there, pressed, force, pieces), limit, 1e-12);
  }
}

TEST_F(Coupled, EnergySlopeAlongTheSurface) {
  for (int trial = 0; trial < 300; ++trial) {
    const SurfacePoint p = random_point();
    const LocalModel model(surface_, p, 0.0003);
    const Vec3 x = tip(model, between(0.0005, 0.006), between(0.0005, 0.004));
    const Deflection d = model.deflection(x);
    const runtime::Element& e = surface_.element(p.element);
    Vec3 along = d.tangent - dot(d.tangent, e.facet_normal) * e.facet_normal;
    along = (1 / norm(along)) * along;
    const double h = 1e-7;
    const auto energy = [&](double s) {
      SurfacePoint moved = p;
      for (std::size_t l = 0; l < 3; ++l) moved.natural[l] += s * dot(e.gradient[l], along);
      return at(LocalModel(surface_, moved, 0.0003), x).energy;
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
