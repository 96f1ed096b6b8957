// SPDX-License-Identifier: AGPL-3.0-or-later
// The local model is a conservative field: its force is the gradient of its energy, whatever the
// path, and its Jacobian is no steeper than the steepest stored slope.
#include "runtime/local_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "runtime/sliding.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::Deflection;
using runtime::Element;
using runtime::LocalModel;
using runtime::Surface;
using runtime::SurfacePoint;

class LocalModelTest : public ::testing::Test {
 protected:
  SurfacePoint random_point() {
    std::uniform_real_distribution<double> any(0.02, 1);
    const Vec3 n{any(random_), any(random_), any(random_)};
    const auto count = static_cast<unsigned>(surface_.element_count());
    return {static_cast<std::int32_t>(random_() % count), (1.0 / (n[0] + n[1] + n[2])) * n};
  }
  /// A tip with a depth of 1 .. 6 mm and a lateral deflection of 0.5 .. 4 mm.
  Vec3 random_tip(const LocalModel& model) {
    std::uniform_real_distribution<double> any(-1, 1);
    const Vec3 n = model.normal();
    Vec3 side{any(random_), any(random_), any(random_)};
    side = side - dot(side, n) * n;
    side = (1.0 / norm(side)) * side;
    return model.contact_point() + (0.0035 + 0.0025 * any(random_) + model.offset()) * n +
           (0.00225 + 0.00175 * any(random_)) * side;
  }
  static Vec3 force(const LocalModel& model, const Vec3& x) {
    return model.respond(model.deflection(x)).force;
  }
  static double energy(const LocalModel& model, const Vec3& x) {
    return model.energy(model.deflection(x));
  }

  static void expect_gradient(const LocalModel& model, const Vec3& x) {
    const double h = 1e-7;
    const Vec3 f = force(model, x);
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3 up = x, down = x;
      up[i] += h;
      down[i] -= h;
      EXPECT_NEAR((energy(model, up) - energy(model, down)) / (2 * h), f[i], 1e-7);
    }
  }

  /// c along d in its element, c + s by a': s is what is left of c + s - c across n(c). The anchor
  /// rests while c catches up with it, or slips along t.
  void expect_slope_of_energy(const Surface& body, bool anchor_rests) {
    const double h = 2e-7;
    std::uniform_real_distribution<double> any(-1, 1);
    const SurfacePoint p = random_point();
    LocalModel model(body, p, 0.0005);
    model.set_grip({body.leans() || body.has_soft_axes() ? 0.003 : 0.0, {}});
    const Vec3 x = random_tip(model);
    model.set_lateral_offset(0.002 * Vec3{any(random_), any(random_), any(random_)});
    const Vec3 anchor = model.contact_point() + model.lateral_offset();
    const Element& e = body.element(p.element);
    Vec3 d{any(random_), any(random_), any(random_)};
    d = d - dot(d, e.facet_normal) * e.facet_normal;
    d = (1.0 / norm(d)) * d;
    const Vec3 rate = anchor_rests ? Vec3{} : any(random_) * model.deflection(x).tangent;
    const auto moved = [&](double s) {
      SurfacePoint q = p;
      for (std::size_t l = 0; l < 3; ++l) q.natural[l] += s * dot(e.gradient[l], d);
      LocalModel there(body, q, 0.0005);
      there.set_grip(model.grip());
      there.set_lateral_offset(anchor + s * rate - there.contact_point());
      return energy(there, x);
    };
    const double numeric = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h);
    const double exact = model.energy_slope(model.deflection(x), d, rate);
    EXPECT_NEAR(numeric, exact, 1e-7 * std::max(1.0, std::abs(exact)));
  }

  Surface surface_{bumpy_sphere(2, 0.03, 0.2, uneven)};
  std::mt19937 random_{7};
};

constexpr double kMostLean = 0.3;
constexpr double kLongestSoftAxis = 0.5;

/// Responses that lean, decoupled and coupled in turn.
class LeaningModelTest : public LocalModelTest {
 protected:
  const Surface& surface(int trial) const { return both_[static_cast<std::size_t>(trial % 2)]; }

 private:
  std::array<Surface, 2> both_{
      Surface(leaning(bumpy_sphere(2, 0.03, 0.2, uneven), kMostLean)),
      Surface(leaning(coupled(bumpy_sphere(2, 0.03, 0.2, uneven)), kMostLean))};
};

TEST_F(LeaningModelTest, ForceIsTheGradientOfTheEnergy) {
  std::uniform_real_distribution<double> any(-0.003, 0.003);
  double furthest = 0;
  for (int trial = 0; trial < 600; ++trial) {
    LocalModel model(surface(trial), random_point(), 0.0004);
    const Vec3 x = random_tip(model);
    model.set_lateral_offset({any(random_), any(random_), any(random_)});
    const Vec3 straight = model.contact_point() + 0.004 * model.normal() + model.lateral_offset();
    const Vec3 leans = force(model, straight);
    furthest =
        std::max(furthest, norm(leans - dot(leans, model.normal()) * model.normal()) / norm(leans));
    expect_gradient(model, x);
  }
  EXPECT_GT(furthest, 0.05);  // presses do lean
}

TEST_F(LeaningModelTest, AStraightPressLeansAgainstItsLean) {
  for (int trial = 0; trial < 200; ++trial) {
    const LocalModel model(surface(trial), random_point(), 0);
    const Deflection d = model.deflection(model.contact_point() + 0.003 * model.normal());
    const auto r = model.respond(d);
    EXPECT_NEAR(d.lateral, 0.003 * norm(model.lean()), 1e-15);
    EXPECT_NEAR(dot(model.lean(), model.normal()), 0, 1e-15);
    EXPECT_NEAR(norm(model.lateral_displacement(d)), 0, 1e-15);
    EXPECT_NEAR(norm(r.force - dot(r.force, model.normal()) * model.normal() +
                     (r.lateral_force / norm(model.lean())) * model.lean()),
                0, 1e-12);
    // A tool that moves along n + sigma shears nothing, and feels the normal response alone.
    const auto along = model.respond(
        model.deflection(model.contact_point() + 0.003 * (model.normal() + model.lean())));
    EXPECT_NEAR(norm(along.force - along.normal_force * model.normal()), 0, 1e-9);
  }
}

TEST_F(LeaningModelTest, EnergySlopeAgreesWithMovingTheContactPointAndTheAnchor) {
  for (int trial = 0; trial < 1000; ++trial) expect_slope_of_energy(surface(trial), trial % 4 < 2);
}

/// Coupled responses with soft axes, which lean or not in turn.
class SoftModelTest : public LocalModelTest {
 protected:
  const Surface& surface(int trial) const { return both_[static_cast<std::size_t>(trial % 2)]; }

 private:
  std::array<Surface, 2> both_{
      Surface(soft_axes(coupled(bumpy_sphere(2, 0.03, 0.2, uneven)), kLongestSoftAxis)),
      Surface(soft_axes(leaning(coupled(bumpy_sphere(2, 0.03, 0.2, uneven)), kMostLean),
                        kLongestSoftAxis))};
};

TEST_F(SoftModelTest, ForceIsTheGradientOfTheEnergy) {
  std::uniform_real_distribution<double> any(-0.003, 0.003);
  double furthest = 0;
  for (int trial = 0; trial < 600; ++trial) {
    LocalModel model(surface(trial), random_point(), 0.0004);
    model.set_grip({0.003, {}});
    const Vec3 x = random_tip(model);
    model.set_lateral_offset({any(random_), any(random_), any(random_)});
    const Deflection d = model.deflection(x);
    const Vec3 q = model.lateral_displacement(d) - model.shear(d), f = force(model, x);
    const Vec3 across = f - dot(f, model.normal()) * model.normal();
    furthest = std::max(furthest, norm(cross(q, across)) / (norm(q) * norm(across)));
    EXPECT_LE(norm(across), model.respond(d).lateral_force * (1 + 1e-12));  // |S| <= 1
    expect_gradient(model, x);
  }
  EXPECT_GT(furthest, 0.1);  // forces are not along the deflections
}

TEST_F(SoftModelTest, EnergySlopeAgreesWithMovingTheContactPointAndTheAnchor) {
  for (int trial = 0; trial < 1000; ++trial) expect_slope_of_energy(surface(trial), trial % 4 < 2);
}

TEST_F(SoftModelTest, ASlipBringsTheForceToItsLimitInTheSameDirection) {
  for (int trial = 0; trial < 300; ++trial) {
    LocalModel model(surface(trial), random_point(), 0);
    model.set_grip({0.003, {}});
    const Vec3 x = random_tip(model);
    runtime::ToolPieces pieces;
    Deflection d = model.deflection(x);
    runtime::LocalResponse at = model.respond(d, pieces);
    const double limit = 0.6 * at.lateral_force, before = at.energy;
    const Vec3 tangent = d.tangent;
    const auto slip = model.slip_within(d, at, limit, pieces);
    EXPECT_NEAR(slip.distance, norm(slip.part(1)), 1e-15);
    model.slip(slip, d, at, pieces);
    // The deflection at x is that with the new offset.
    const Deflection there = model.deflection(x);
    EXPECT_NEAR(there.lateral, d.lateral, 1e-12);
    EXPECT_NEAR(norm(there.tangent - tangent), 0, 1e-9);
    EXPECT_NEAR(model.respond(there).lateral_force, limit, 1e-9);
    EXPECT_LT(at.energy, before);
  }
}

TEST_F(LocalModelTest, ForceIsTheGradientOfTheEnergy) {
  for (int trial = 0; trial < 300; ++trial) {
    const LocalModel model(surface_, random_point(), 0.0004);
    const Vec3 x = random_tip(model);
    expect_gradient(model, x);
  }
}

std::array<Vec3, 3> jacobian(const LocalModel& model, const Vec3& x) {
  const double h = 1e-7;
  std::array<Vec3, 3> columns;
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3 up = x;
    Vec3 down = x;
    up[i] += h;
    down[i] -= h;
    columns[i] = (1 / (2 * h)) * (model.respond(model.deflection(up)).force -
                                  model.respond(model.deflection(down)).force);
  }
  return columns;
}

TEST_F(LocalModelTest, HasNoCurlAndIsNoSteeperThanTheSteepestSlope) {
  double steepest = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const LocalModel model(surface_, random_point(), 0.0002);
    const auto J = jacobian(model, random_tip(model));
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(J[i][j], J[j][i], 2e-4);
    }
    Vec3 v{0.5, 0.6, 0.7};  // power iteration on J^T J
    for (int i = 0; i < 60; ++i) {
      const Vec3 w = v[0] * J[0] + v[1] * J[1] + v[2] * J[2];
      v = {dot(J[0], w), dot(J[1], w), dot(J[2], w)};
      v = (1.0 / norm(v)) * v;
    }
    steepest = std::max(steepest, norm(v[0] * J[0] + v[1] * J[1] + v[2] * J[2]));
  }
  EXPECT_LE(steepest, kSteepestUneven * (1 + 1e-6));
  EXPECT_GT(steepest, 0.3 * kSteepestUneven);  // the search came near the bound
}

TEST_F(LocalModelTest, EnergyDoesNotDependOnThePath) {
  // Work along a straight line and along a detour, by Simpson's rule with many intervals.
  const auto work = [](const LocalModel& model, auto path) {
    const int n = 4000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const Vec3 a = path(1.0 * i / n);
      const Vec3 b = path((i + 1.0) / n);
      const Vec3 f =
          (1.0 / 6) * (force(model, a) + 4.0 * force(model, 0.5 * (a + b)) + force(model, b));
      sum += dot(f, b - a);
    }
    return sum;
  };
  for (int trial = 0; trial < 5; ++trial) {
    const LocalModel model(surface_, random_point(), 0.0003);
    const Vec3 start = model.contact_point() + 0.0003 * model.normal();  // E = 0
    const Vec3 end = random_tip(model);
    const Vec3 detour{0.002, -0.001, 0.0015};
    const double straight = work(model, [&](double s) { return start + s * (end - start); });
    const double around = work(model, [&](double s) {
      return start + s * (end - start) + std::sin(3 * std::acos(-1.0) * s) * detour;
    });
    EXPECT_NEAR(straight, energy(model, end), 1e-9);
    EXPECT_NEAR(around, energy(model, end), 1e-9);
  }
}

TEST_F(LocalModelTest, EnergySlopeAgreesWithMovingTheContactPoint) {
  const double h = 2e-7;
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 500; ++trial) {
    const SurfacePoint p = random_point();
    const LocalModel model(surface_, p, 0.0005);
    const Vec3 x = random_tip(model);
    const Element& e = surface_.element(p.element);
    Vec3 d{any(random_), any(random_), any(random_)};
    d = d - dot(d, e.facet_normal) * e.facet_normal;
    d = (1.0 / norm(d)) * d;
    const auto moved = [&](double s) {
      SurfacePoint q = p;
      for (std::size_t l = 0; l < 3; ++l) q.natural[l] += s * dot(e.gradient[l], d);
      return energy(LocalModel(surface_, q, 0.0005), x);
    };
    const double numeric = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h);
    const double exact = model.energy_slope(model.deflection(x), d);
    EXPECT_NEAR(numeric, exact, 1e-7 * std::max(1.0, std::abs(exact)));
  }
}

TEST_F(LocalModelTest, ALateralOffsetKeepsTheFieldConservative) {
  const double h = 1e-7;
  std::uniform_real_distribution<double> any(-0.003, 0.003);
  for (int trial = 0; trial < 300; ++trial) {
    LocalModel model(surface_, random_point(), 0.0004);
    const Vec3 x = random_tip(model);
    model.set_lateral_offset({any(random_), any(random_), any(random_)});
    EXPECT_NEAR(dot(model.lateral_offset(), model.normal()), 0, 1e-17);
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3 up = x, down = x;
      up[i] += h;
      down[i] -= h;
      EXPECT_NEAR((energy(model, up) - energy(model, down)) / (2 * h), force(model, x)[i], 1e-7);
    }
  }
}

TEST_F(LocalModelTest, EnergySlopeAgreesWithMovingTheContactPointAndTheAnchor) {
  for (int trial = 0; trial < 500; ++trial) expect_slope_of_energy(surface_, trial % 2 == 0);
}

TEST_F(LocalModelTest, ForceAndEnergyAreContinuousAcrossEdges) {
  for (std::int32_t m = 0; m < surface_.element_count(); ++m) {
    const Element& here = surface_.element(m);
    for (std::size_t l = 0; l < 3; ++l) {
      const std::int32_t next = here.neighbour[l];
      SurfacePoint a{m, {}};
      a.natural[(l + 1) % 3] = 0.3;
      a.natural[(l + 2) % 3] = 0.7;
      SurfacePoint b{next, {}};
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          if (here.vertices[i] == surface_.element(next).vertices[j]) b.natural[j] = a.natural[i];
        }
      }
      const LocalModel left(surface_, a, 0.0002);
      const LocalModel right(surface_, b, 0.0002);
      const Vec3 x = random_tip(left);
      EXPECT_NEAR(norm(force(left, x) - force(right, x)), 0, 1e-12);
      EXPECT_NEAR(energy(left, x), energy(right, x), 1e-15);
    }
  }
}

TEST_F(LocalModelTest, ReproducesTheNodalResponseAtAVertex) {
  for (std::int32_t m = 0; m < surface_.element_count(); m += 17) {
    const LocalModel model(surface_, {m, {0, 1, 0}}, 0);
    const Element& e = surface_.element(m);
    const runtime::CompiledCurve nodal(uneven(surface_.vertex(e, 1)).normal);
    const Vec3 n = surface_.inward(e, 1);
    const Vec3 f = force(model, surface_.vertex(e, 1) + 0.004 * n);
    EXPECT_NEAR(norm(f - nodal.force(0.004) * n), 0, 1e-12);
  }
}

TEST_F(LocalModelTest, SlipLimitIsWhereLateralForceReachesMuTimesNormalForce) {
  for (int trial = 0; trial < 200; ++trial) {
    const LocalModel model(surface_, random_point(), 0);
    const Vec3 x = random_tip(model);
    Deflection d = model.deflection(x);
    d.lateral = model.slip_limit(d, 0.3);
    const auto r = model.respond(d);
    EXPECT_NEAR(r.lateral_force, 0.3 * r.normal_force, 1e-12);
  }
}

TEST_F(LocalModelTest, SlippingOverAHeldContactPointIsWhatTheNewOffsetGives) {
  const Surface both[] = {Surface(bumpy_sphere(2, 0.03, 0.2, uneven)),
                          Surface(coupled(bumpy_sphere(2, 0.03, 0.2, uneven)))};
  std::uniform_real_distribution<double> any(0, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    LocalModel model(both[trial % 2], random_point(), 0.0004);
    const Vec3 x = random_tip(model);
    model.set_lateral_offset(0.001 * Vec3{any(random_), any(random_), any(random_)});
    Deflection d = model.deflection(x);
    runtime::ToolPieces pieces;
    auto slipped = model.respond(d, pieces);
    const double left = trial % 10 == 0 ? 0 : d.lateral * any(random_);
    model.slip({d.lateral - left, d.lateral - left, d.tangent, left, left > 0 ? d.tangent : Vec3{}},
               d, slipped, pieces);
    const Deflection fresh = model.deflection(x);
    const auto want = model.respond(fresh);
    EXPECT_EQ(d.lateral, left);
    EXPECT_NEAR(fresh.lateral, left, 1e-17);
    EXPECT_EQ(d.depth, fresh.depth);
    EXPECT_NEAR(norm(slipped.force - want.force), 0, 1e-13);
    EXPECT_NEAR(slipped.energy, want.energy, 1e-12 * want.energy);
    EXPECT_NEAR(dot(model.lateral_offset(), model.normal()), 0, 1e-17);
  }
}

}  // namespace
}  // namespace palpate::test
