// SPDX-License-Identifier: AGPL-3.0-or-later
// Where a contact begins and how large it grows, against closed forms.
#include "fem/campaign/contact_size.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// A block whose top is an elliptic paraboloid, curvatures in 1/m, positive where it is convex.
QuadraticMesh paraboloid(double kx, double ky) {
  Body body = test::make_block(test::even(-0.02, 0.02, 10), test::even(-0.02, 0.02, 10),
                               test::even(-0.02, 0, 4));
  test::deform(body, [&](const Vec3& x) {
    return Vec3{x[0], x[1], x[2] - 0.5 * (kx * x[0] * x[0] + ky * x[1] * x[1])};
  });
  return make_quadratic_mesh(body);
}

Tool tool(const ToolGeometry& geometry) {
  Tool t;
  t.geometry = geometry;
  return t;
}

TEST(ContactSize, FindsTheCurvaturesOfAParaboloid) {
  const QuadraticMesh mesh = paraboloid(30, -10);
  const auto k = curvature_at(mesh, {0, 0, 0}, -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(),
                              Eigen::Vector3d::UnitY(), 0.012);
  EXPECT_NEAR(k.k11, 30, 0.5);
  EXPECT_NEAR(k.k22, -10, 0.5);
  EXPECT_NEAR(k.k12, 0, 0.2);
}

/// In a frame turned by 45 degrees the same surface has a mixed curvature.
TEST(ContactSize, TurnsTheCurvaturesWithTheFrame) {
  const QuadraticMesh mesh = paraboloid(30, -10);
  const Eigen::Vector3d first = Eigen::Vector3d(1, 1, 0).normalized();
  const auto k = curvature_at(mesh, {0, 0, 0}, -Eigen::Vector3d::UnitZ(), first,
                              Eigen::Vector3d(-1, 1, 0).normalized(), 0.012);
  EXPECT_NEAR(k.k11, 10, 0.5);
  EXPECT_NEAR(k.k22, 10, 0.5);
  EXPECT_NEAR(std::abs(k.k12), 20, 0.5);
}

TEST(ContactSize, KnowsNoCurvatureBesideASingleFacet) {
  const auto k = curvature_at(paraboloid(30, 30), {0, 0, 0}, -Eigen::Vector3d::UnitZ(),
                              Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), 0.001);
  EXPECT_EQ(k.mean(), 0);
}

/// Two spheres touch in a circle of radius sqrt(R' d), 1/R' = 1/R1 + 1/R2 [Hertz 1881].
TEST(ContactSize, OfASphereIsThatOfHertz) {
  const double R = 0.005;
  for (const double curvature : {0.0, 50.0, -50.0}) {
    const auto cores = contact_cores(paraboloid(curvature, curvature),
                                     tool({ToolShape::Sphere, R, 0, 0}), 0.0002, 0.002);
    ASSERT_EQ(cores.size(), 1u);
    const double effective = 1 / (1 / R + curvature);
    EXPECT_NEAR(cores[0].smallest, std::sqrt(effective * 0.0002), 0.03 * cores[0].smallest);
    EXPECT_NEAR(cores[0].largest, std::sqrt(effective * 0.002), 0.03 * cores[0].largest);
    EXPECT_LT((cores[0].nearest({0.001, 0.002, -0.003}) - Eigen::Vector3d::Zero()).norm(), 1e-15);
  }
}

/// A hollow that fits the sphere would make the contact infinite.
TEST(ContactSize, InAFittingHollowIsBounded) {
  const auto cores =
      contact_cores(paraboloid(-200, -200), tool({ToolShape::Sphere, 0.005, 0, 0}), 0.0002, 0.002);
  EXPECT_NEAR(cores[0].largest, std::sqrt(4 * 0.005 * 0.002), 1e-9);
}

TEST(ContactSize, OfACylinderIsMeasuredFromItsAxis) {
  const auto cores =
      contact_cores(paraboloid(0, 0), tool({ToolShape::Cylinder, 0.003, 0, 0.01}), 0.0001, 0.001);
  ASSERT_EQ(cores.size(), 1u);
  EXPECT_LT((cores[0].nearest({0.002, 0.004, -0.001}) - Eigen::Vector3d(0.002, 0, 0)).norm(),
            1e-12);
  EXPECT_LT((cores[0].nearest({0.02, 0.004, 0}) - Eigen::Vector3d(0.005, 0, 0)).norm(), 1e-12);
}

TEST(ContactSize, OfADiscIsMeasuredFromItsFillet) {
  const ToolGeometry disc{ToolShape::Disc, 0.005, 0.001, 0};
  const auto flat = contact_cores(paraboloid(0, 0), tool(disc), 0.0002, 0.002);
  ASSERT_EQ(flat.size(), 1u);
  EXPECT_LT((flat[0].nearest({0.001, 0, 0}) - Eigen::Vector3d(0.004, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR(flat[0].smallest, std::sqrt(0.001 * 0.0002), 1e-12);
  // A convex body meets the disc at the middle first; its ring lies deeper.
  const auto convex = contact_cores(paraboloid(50, 50), tool(disc), 0.0002, 0.002);
  ASSERT_EQ(convex.size(), 2u);
  EXPECT_EQ(convex[0].ring_radius, 0);
  EXPECT_NEAR(convex[1].ring_sag, 0.5 * 50 * 0.004 * 0.004, 2e-5);
  EXPECT_TRUE(
      contact_cores(paraboloid(0, 0), tool({ToolShape::Disc, 0.005, 0, 0}), 0.0002, 0.002).empty());
}

}  // namespace
}  // namespace palpate::fem
