// SPDX-License-Identifier: AGPL-3.0-or-later
// The responses at the deflections of all relaxation times against evaluation of the curves and
// against what a conjugate energy is.
#include "runtime/kept_pieces.hpp"

#include <gtest/gtest.h>

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
  EXPECT_GE(reached.conjugate(both(force), i / 2)[i % 2],
            force * other - value(other).energy - 1e-14);
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
    NormalPieces normal(lanes);
    LateralPieces lateral(lanes);
    for (int trial = 0; trial < 4000; ++trial) {
      const InterpolatedResponse r = (trial % 40 < 20 ? one : other).at(random_natural(random));
      const auto g = [&](double z) { return r.normal(z); };
      const auto h = [&](double rho) { return r.lateral(rho); };
      const Lanes normal_forces = random_forces(lanes, g, random);
      const Lanes lateral_forces = random_forces(lanes, h, random);
      ReachedForces z, fresh, rho;
      normal.reach(r, normal_forces, z);
      NormalPieces(lanes).reach(r, normal_forces, fresh);
      lateral.reach(r, lateral_forces, rho);
      for (std::size_t i = 0; i < lanes; ++i) {
        const double d = 0.03 * any(random);
        EXPECT_EQ(z.deflection[i], fresh.deflection[i]);
        EXPECT_EQ(z.energy[i], fresh.energy[i]);
        EXPECT_EQ(rho.deflection[i], r.lateral_inverse(lateral_forces[i]));
        expect_reached(z, i, normal_forces[i], g, d);
        expect_reached(rho, i, lateral_forces[i], h, d);
      }
    }
  }
}

TEST(KeptPieces, ValuesAreThoseOfTheResponse) {
  constexpr std::size_t kLanes = 5;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0, 0.03);
  const RandomNodes one(random), other(random, true);
  LateralPieces pieces(kLanes);
  for (int trial = 0; trial < 4000; ++trial) {
    const InterpolatedResponse r = (trial % 40 < 20 ? one : other).at(random_natural(random));
    Lanes deflections;
    for (std::size_t i = 0; i < kLanes; ++i)
      if (random() % 8 > 0) deflections.set(i, any(random));
    ReachedForces at;
    pieces.evaluate(r, deflections, at);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const CurveValue expected = r.lateral(deflections[i]);
      EXPECT_EQ(at.deflection[i], deflections[i]);
      EXPECT_NEAR(at.force[i], expected.force, 1e-12 * expected.force);
      EXPECT_NEAR(at.energy[i], expected.energy, 1e-12 * expected.energy);
    }
  }
}

TEST(KeptPieces, AForceBeyondEveryDepthIsReachedNowhere) {
  const CompiledCurve flat(ResponseCurve{{0.0F, 0.001F, 0.002F}, {100.0F, 0.0F, 0.0F}});
  std::array<CacheLine, 4> memory;
  const NodeCurves node = NodeCurves::write(memory.data(), flat, flat);
  const InterpolatedResponse r({&node, &node, &node}, {0.2, 0.3, 0.5});
  NormalPieces pieces(3);
  Lanes forces;
  forces.set(0, 0.06);
  forces.set(1, 0.04);
  ReachedForces at;
  pieces.reach(r, forces, at);
  EXPECT_TRUE(std::isinf(at.conjugate(forces.pair[0], 0)[0]));
  EXPECT_NEAR(at.force[1], 0.04, 1e-14);
  EXPECT_EQ(at.deflection[2], 0);
}

}  // namespace
}  // namespace palpate::runtime
