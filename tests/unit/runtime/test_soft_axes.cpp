// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/soft_axes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::runtime {
namespace {

const Vec3 kNormal{0, 0.6, 0.8};

/// A vector across the normal.
Vec3 across(const Vec3& v) {
  return v - dot(v, kNormal) * kNormal;
}

Vec3 random_across(std::mt19937& engine, double most) {
  std::uniform_real_distribution<double> u(-1, 1);
  const Vec3 v = across({u(engine), u(engine), u(engine)});
  return most * std::abs(u(engine)) / norm(v) * v;
}

TEST(SoftAxes, ShortenWhatIsAlongASingleAxisAndNothingElse) {
  const Vec3 b = across({0.3, 0.2, -0.1}), beside = cross(kNormal, b);
  SoftAxes axes;
  axes.add(1, b);
  axes.finish();
  EXPECT_LT(norm(axes.stretch(b) - (1 - dot(b, b)) * b), 1e-15);
  EXPECT_LT(norm(axes.stretch(beside) - beside), 1e-15);
  EXPECT_LT(norm(axes.restore(b) - (1 / (1 - dot(b, b))) * b), 1e-15);
}

TEST(SoftAxes, OfThreeVerticesAreSymmetricAndRestoreWhatTheyStretch) {
  std::mt19937 engine(5);
  for (int trial = 0; trial < 200; ++trial) {
    SoftAxes axes, mirrored;
    for (const double natural : {0.2, 0.5, 0.3}) {
      const Vec3 b = random_across(engine, 0.7);
      axes.add(natural, b);
      mirrored.add(natural, -b);
    }
    axes.finish();
    mirrored.finish();
    const Vec3 u = random_across(engine, 1), v = random_across(engine, 1), S_u = axes.stretch(u);
    EXPECT_NEAR(dot(v, S_u), dot(u, axes.stretch(v)), 1e-15);
    EXPECT_NEAR(dot(S_u, kNormal), 0, 1e-15);
    EXPECT_LT(norm(axes.restore(S_u) - u), 1e-14);
    EXPECT_EQ(mirrored.stretch(u), S_u);
    EXPECT_LE(norm(S_u), norm(u));
    EXPECT_GE(norm(S_u), 0.51 * norm(u));
  }
}

TEST(SoftAxes, LeaveEverythingWhereThereAreNone) {
  const SoftAxes none;
  const Vec3 v{0.1, 0.2, 0.3};
  EXPECT_FALSE(none.any());
  EXPECT_EQ(none.stretch(v), v);
  EXPECT_EQ(none.restore(v), v);
}

}  // namespace
}  // namespace palpate::runtime
