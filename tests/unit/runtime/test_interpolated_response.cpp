// SPDX-License-Identifier: AGPL-3.0-or-later
// Interpolated responses against the identities of interpolation, and the closed-form inverse
// against bisection.
#include "runtime/interpolated_response.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/unit/runtime/random_nodes.hpp"

namespace palpate::runtime {
namespace {

TEST(InterpolatedResponse, ReproducesTheNodesAtTheVertices) {
  std::mt19937 random(1);
  const RandomNodes nodes(random);
  for (std::size_t l = 0; l < 3; ++l) {
    Vec3 natural{};
    natural[l] = 1;
    for (const double d : {-0.001, 0.0, 0.0004, 0.003, 0.05}) {
      EXPECT_EQ(nodes.at(natural).normal(d).force, nodes.curves[l][0].force(d));
      EXPECT_EQ(nodes.at(natural).normal(d).energy, nodes.curves[l][0].energy(d));
      EXPECT_EQ(nodes.at(natural).lateral(d).force, nodes.curves[l][1].force(d));
    }
  }
}

TEST(InterpolatedResponse, ThreeEqualNodesGiveThatNodeEverywhere) {
  std::mt19937 random(2);
  RandomNodes nodes(random);
  nodes.packed[1] = nodes.packed[2] = nodes.packed[0];
  for (int trial = 0; trial < 100; ++trial) {
    const InterpolatedResponse r = nodes.at(random_natural(random));
    const double d = 1e-4 * trial;
    EXPECT_NEAR(r.normal(d).force, nodes.curves[0][0].force(d), 1e-13);
    EXPECT_NEAR(r.lateral(d).slope, nodes.curves[0][1].slope(d), 1e-11);
  }
}

TEST(InterpolatedResponse, IsLinearInTheNaturalCoordinates) {
  std::mt19937 random(3);
  const RandomNodes nodes(random);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 a = random_natural(random);
    const Vec3 b = random_natural(random);
    const Vec3 middle = 0.5 * (a + b);
    const double d = 1e-4 * trial;
    EXPECT_NEAR(nodes.at(middle).normal(d).energy,
                (nodes.at(a).normal(d).energy + nodes.at(b).normal(d).energy) / 2, 1e-15);
    EXPECT_NEAR(nodes.at(middle).lateral(d).force,
                (nodes.at(a).lateral(d).force + nodes.at(b).lateral(d).force) / 2, 1e-12);
  }
}

/// Smallest rho with h(rho) >= force by bisection; the curve is not decreasing.
double bisect(const InterpolatedResponse& r, double force, double high) {
  double low = 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (r.lateral(middle).force < force ? low : high) = middle;
  }
  return high;
}

TEST(InterpolatedResponse, LateralInverseAgreesWithBisection) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(0, 1);
  for (int trial = 0; trial < 5000; ++trial) {
    const RandomNodes nodes(random, trial % 2 == 0);
    const InterpolatedResponse r = nodes.at(random_natural(random));
    const double reach = 0.03 * any(random);
    const double force = r.lateral(reach).force * any(random);
    const double rho = r.lateral_inverse(force);
    ASSERT_TRUE(std::isfinite(rho));
    EXPECT_NEAR(r.lateral(rho).force, force, 1e-12 * (1 + force));
    EXPECT_EQ(r.lateral_inverse_below(force, reach), rho);
    // A plateau makes the location ill-conditioned, so the force decides; where it rises, both
    // agree.
    if (force > 0 && r.lateral(rho).slope > 1) {
      EXPECT_NEAR(rho, bisect(r, force, reach + 1e-9), 1e-12);
    }
  }
}

/// Sums of nodal curves as equations (29*) and (32*) write them.
struct Sums {
  double g = 0, G = 0, h = 0, H = 0;
  double lateral = 0, weighted = 0;  // sum n_l w_l(z) h_l, and its energy
};
Sums sums_of(const RandomNodes& nodes, const Vec3& n, double z, double rho) {
  Sums s;
  for (std::size_t l = 0; l < 3; ++l) {
    const CurveValue g = nodes.curves[l][0].evaluate(z);
    const CurveValue h = nodes.curves[l][1].evaluate(rho);
    const CurveValue w = nodes.curves[l][2].evaluate(std::max(z, 1e-300));
    s.g += n[l] * g.force;
    s.G += n[l] * g.energy;
    s.h += n[l] * h.force;
    s.H += n[l] * h.energy;
    s.lateral += n[l] * w.force * h.force;
    s.weighted += n[l] * w.force * h.energy;
  }
  return s;
}

TEST(InterpolatedResponse, RememberedPiecesGiveTheSumsOfTheCurvesFromWhateverStateTheyAreLeftIn) {
  // One memory for walks over depths and deflections on the nodes of several triangles, with jumps
  // from one end of the curves to the other, onto knots, out of contact and beyond the last knot.
  std::mt19937 random(5);
  std::vector<RandomNodes> triangles;
  for (int k = 0; k < 6; ++k) triangles.emplace_back(random, k % 2 == 1);
  for (RandomNodes& t : triangles) {  // copies: their curves lie elsewhere now
    for (std::size_t l = 0; l < 3; ++l) {
      t.packed[l] = NodeCurves::write(t.memory[l].data(), t.curves[l][0], t.curves[l][1]);
      t.coupled[l] =
          NodeCurves::write(t.more[l].data(), t.curves[l][0], t.curves[l][1], t.curves[l][2]);
    }
  }
  std::uniform_real_distribution<double> any(0, 1);
  PiecesInUse decoupled, coupled;
  double z = 0.001, rho = 0.001;
  const RandomNodes* nodes = &triangles[0];
  Vec3 natural{0.2, 0.3, 0.5};
  for (int trial = 0; trial < 200000; ++trial) {
    if (trial % 5 == 0) nodes = &triangles[random() % triangles.size()];
    if (trial % 3 == 0) natural = random_natural(random);
    z += 1e-4 * (any(random) - 0.5);
    rho = std::abs(rho + 1e-4 * (any(random) - 0.5));
    if (trial % 11 == 0) z = 0.03 * any(random) - 0.005;
    if (trial % 13 == 0) rho = 0.03 * any(random);
    if (trial % 17 == 0) z = rho = 0;
    const std::size_t corner = random() % 3;
    if (trial % 7 == 0) z = nodes->curves[corner][0].pieces().back().start;
    if (trial % 19 == 0) rho = nodes->curves[corner][1].pieces()[1].start;
    const Sums want = sums_of(*nodes, natural, z, rho);
    const auto a = nodes->at(natural).decoupled_at(z, rho, decoupled);
    EXPECT_NEAR(a.normal.force, want.g, 1e-12 * want.g);
    EXPECT_NEAR(a.lateral.force, want.h, 1e-12 * want.h);
    EXPECT_NEAR(a.normal.energy, want.G, 1e-12 * want.G);
    EXPECT_NEAR(a.lateral.energy, want.H, 1e-12 * want.H);
    const InterpolatedResponse r = nodes->coupled_at(natural);
    const double held = z * any(random);
    const Sums hold = sums_of(*nodes, natural, held, rho);
    const Vec3 weights = r.lateral_weights(held, coupled);
    EXPECT_NEAR(norm(weights - r.lateral_weights(held)), 0, 1e-12 * norm(weights));
    const auto b = r.weighted_at(z, rho, weights, coupled);
    EXPECT_NEAR(b.normal.force, want.g, 1e-12 * want.g);
    EXPECT_NEAR(b.normal.energy, want.G, 1e-12 * want.G);
    EXPECT_NEAR(b.lateral.force, hold.lateral, 1e-12 * hold.lateral);
    EXPECT_NEAR(b.lateral.energy, hold.weighted, 1e-12 * hold.weighted);
    const double force = b.lateral.force * any(random);
    EXPECT_EQ(r.lateral_inverse_below(force, rho, weights, coupled),
              r.lateral_inverse(force, weights));
  }
}

TEST(InterpolatedResponse, NothingSlipsWhereTheLateralForceStaysBelowTheLimit) {
  const CompiledCurve lateral(ResponseCurve{{0.0F, 0.001F, 0.002F}, {100.0F, 0.0F, 0.0F}});
  std::array<CacheLine, 4> memory;
  const NodeCurves flat = NodeCurves::write(memory.data(), CompiledCurve(), lateral);
  const InterpolatedResponse r({&flat, &flat, &flat}, {0.2, 0.3, 0.5});
  EXPECT_NEAR(r.lateral(1.0).force, 0.05, 1e-8);  // knots are single precision
  EXPECT_TRUE(std::isinf(r.lateral_inverse(0.06)));
  EXPECT_TRUE(std::isfinite(r.lateral_inverse(0.04)));
  EXPECT_EQ(r.lateral_inverse(0.0), 0.0);
  EXPECT_EQ(r.lateral_inverse(-1.0), 0.0);
}

}  // namespace
}  // namespace palpate::runtime
