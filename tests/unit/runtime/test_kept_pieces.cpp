// SPDX-License-Identifier: AGPL-3.0-or-later
// The responses at the deflections of all relaxation times against evaluation of the curves and
// against what a conjugate energy is.
#include "runtime/kept_pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "tests/unit/runtime/random_nodes.hpp"

namespace palpate::runtime {
namespace {

/// What a reached force is to a response, independently of how it was found: force and energy are
/// those of the response there, and the conjugate energy is the largest F d - E.
template <typename Value>
void expect_reached(const ReachedForces& reached, std::size_t i, double force, const Value& value,
                    double other) {
  const CurveValue there = value(reached.deflection[i]);
  EXPECT_NEAR(reached.force[i], force, 1e-12 * (1 + force));
  EXPECT_NEAR(there.force, force, 1e-12 * (1 + force));
  EXPECT_NEAR(reached.energy[i], there.energy, 1e-12 * there.energy);
  EXPECT_GE(reached.conjugate(both(force))[i], force * other - value(other).energy - 1e-14);
}

/// Forces of a response at random deflections up to 20 mm, and now and then none.
template <typename Value>
Lanes random_forces(std::size_t lanes, const Value& value, std::mt19937& random) {
  std::uniform_real_distribution<double> any(0, 1);
  Lanes forces;
  for (std::size_t i = 0; i < lanes; ++i)
    if (random() % 8 > 0) forces.set(i, value(0.02 * any(random)).force * any(random));
  return forces;
}

TEST(KeptPieces, ForcesAreReachedAtTheSameDeflectionsWhateverPiecesWereKept) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(0, 1);
  const RandomNodes one(random), other(random, true);
  for (const std::size_t lanes : {1U, 2U, 4U, 9U}) {
    BranchPieces normal(lanes, ResponseOf::Depth), lateral(lanes, ResponseOf::Lateral);
    for (int trial = 0; trial < 4000; ++trial) {
      const InterpolatedResponse r = (trial % 40 < 20 ? one : other).at(random_natural(random));
      const auto g = [&](double z) { return r.normal(z); };
      const auto h = [&](double rho) { return r.lateral(rho); };
      const Lanes normal_forces = random_forces(lanes, g, random);
      const Lanes lateral_forces = random_forces(lanes, h, random);
      BranchPieces fresh(lanes, ResponseOf::Depth);
      for (BranchPieces* pieces : {&normal, &lateral, &fresh})
        pieces->keep_for(r.nodes(), r.natural());
      for (std::size_t i = 0; i < lanes; ++i) {
        const ReachedForces z = normal.reach(i / 2, normal_forces.pair[i / 2]);
        const ReachedForces rho = lateral.reach(i / 2, lateral_forces.pair[i / 2]);
        const ReachedForces again = fresh.reach(i / 2, normal_forces.pair[i / 2]);
        const double d = 0.03 * any(random);
        EXPECT_EQ(z.deflection[i % 2], again.deflection[i % 2]);
        EXPECT_EQ(z.energy[i % 2], again.energy[i % 2]);
        EXPECT_EQ(rho.deflection[i % 2], r.lateral_inverse(lateral_forces[i]));
        expect_reached(z, i % 2, normal_forces[i], g, d);
        expect_reached(rho, i % 2, lateral_forces[i], h, d);
      }
    }
  }
}

TEST(KeptPieces, ValuesAreThoseOfTheResponses) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0, 0.03);
  const RandomNodes one(random), other(random, true);
  TipPieces tip;
  for (int trial = 0; trial < 20000; ++trial) {
    const InterpolatedResponse r = (trial % 40 < 20 ? one : other).at(random_natural(random));
    const Pair d{random() % 8 > 0 ? any(random) : -1e-3, random() % 8 > 0 ? any(random) : 0};
    tip.keep_for(r.nodes(), r.natural(), r.natural());
    const ReachedForces at = tip.evaluate(0, d);
    const CurveValue expected[] = {r.normal(d[0]), r.lateral(d[1])};
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(at.deflection[i], std::max(d[i], 0.0));
      EXPECT_NEAR(at.force[i], expected[i].force, 1e-12 * expected[i].force);
      EXPECT_NEAR(at.energy[i], expected[i].energy, 1e-12 * expected[i].energy);
    }
  }
}

TEST(KeptPieces, AForceBeyondEveryDepthIsReachedNowhere) {
  const CompiledCurve flat(ResponseCurve{{0.0F, 0.001F, 0.002F}, {100.0F, 0.0F, 0.0F}});
  std::array<CacheLine, 4> memory;
  const NodeCurves node = NodeCurves::write(memory.data(), flat, flat);
  TipPieces pieces;
  const Vec3 weights{0.2, 0.3, 0.5};
  pieces.keep_for({&node, &node, &node}, weights, weights);
  const Pair forces{0.06, 0.04};
  const ReachedForces at = pieces.reach(0, forces);
  EXPECT_TRUE(std::isinf(at.conjugate(forces)[0]));
  EXPECT_NEAR(at.force[1], 0.04, 1e-14);
  EXPECT_EQ(pieces.reach(0, Pair{}).deflection[0], 0);
}

}  // namespace
}  // namespace palpate::runtime
