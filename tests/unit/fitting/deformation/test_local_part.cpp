// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/deformation/local_part.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/fitting/deformation/pressed_plate.hpp"

namespace palpate::fitting {
namespace {

class Middle : public testing::Test {
 protected:
  Middle() {
    for (int j = 0; j <= 20; ++j) knots_.push_back(0.001 * j);
    const SkinMesh skin = skin_mesh(plate_.body);
    skin_ = skin.positions;
    normals_ = inward_normals(skin_, skin.triangles);
  }

  Eigen::VectorXf sampled(const SkinField& field, double z, const Vec3& q) const {
    Eigen::VectorXf u(3 * static_cast<Eigen::Index>(skin_.size()));
    for (std::size_t w = 0; w < skin_.size(); ++w) {
      const Vec3 at = field(skin_[w], kCentre, z, q);
      for (std::size_t i = 0; i < 3; ++i)
        u[static_cast<Eigen::Index>(3 * w + i)] = static_cast<float>(at[i]);
    }
    return u;
  }
  double largest(const Eigen::VectorXf& u) const {
    return static_cast<double>(u.cwiseAbs().maxCoeff());
  }

  static constexpr Vec3 kCentre{0.04, 0.04, 0};
  PressedPlate plate_;
  std::vector<double> knots_;
  std::vector<Vec3> skin_, normals_;
  SiteFrame frame_{kCentre, kDown, {1, 0, 0}};
};

TEST_F(Middle, OfADimpleIsAllButItsEnd) {
  const LocalPart local(skin_, normals_, knots_, frame_);
  Eigen::VectorXf u = sampled(dimple, 0.004, {});
  const auto profiles = local.take_press(u, 0.004);
  const double end = std::exp(-6.25);  // of the dimple at the reach
  EXPECT_LT(largest(u), 0.02 * 0.004);
  ASSERT_EQ(profiles.size(), 2 * knots_.size());
  EXPECT_NEAR(static_cast<double>(profiles[0]), 0.004 * (1 - end), 1e-5);
  EXPECT_EQ(profiles[knots_.size()], 0.0F);
  EXPECT_NEAR(static_cast<double>(profiles[knots_.size() - 1]), 0, 1e-9);
  // Between, where the skin is known at 5 mm: to the curvature of the profile over a knot.
  EXPECT_NEAR(static_cast<double>(profiles[5]), 0.004 * (std::exp(-25.0 / 64) - end), 1e-4);
}

TEST_F(Middle, OfALateralDeflectionFollowsItInEveryDirection) {
  const LocalPart local(skin_, normals_, knots_, frame_);
  // Stiffer along than around, with a tilt: what an axisymmetric body does.
  const SkinField lateral = [](const Vec3& x, const Vec3& c, double, const Vec3& q) {
    const Vec3 r = x - c;
    const double s = norm(r), fall = std::exp(-s * s / 4e-5);
    const Vec3 e = s > 0 ? (1 / s) * r : Vec3{};
    return fall * ((1 + 30 * s) * q - 40 * s * dot(e, q) * e + 50 * s * dot(e, q) * kDown);
  };
  const Vec3 second = cross(kDown, frame_.tangent);
  Eigen::VectorXf u = sampled(lateral, 0, frame_.tangent), v = sampled(lateral, 0, second);
  const LocalPart::Lateral taken = local.take_lateral(u, v);
  const auto& profiles = taken.symmetric;
  EXPECT_LT(largest(u), 0.02);
  EXPECT_LT(largest(v), 0.02);
  for (const float p : taken.anisotropic) EXPECT_NEAR(p, 0.0F, 0.01F);
  const double fall = std::exp(-25e-6 / 4e-5);
  EXPECT_NEAR(static_cast<double>(profiles[5]), fall * (1 + 0.15 - 0.2), 0.02);
  EXPECT_NEAR(static_cast<double>(profiles[knots_.size() + 5]), fall * 1.15, 0.02);
  EXPECT_NEAR(static_cast<double>(profiles[2 * knots_.size() + 5]), fall * 0.25, 0.02);
}

/// Softer along `grain`, where the skin also sinks and rises with the deflection: nothing of it is
/// the same after a turn around n.
Vec3 lopsided(const Vec3& x, const Vec3& c, double z, const Vec3& q) {
  const Vec3 r = x - c, grain{std::cos(0.5), std::sin(0.5), 0};
  const double s = norm(r), fall = std::exp(-s * s / 4e-5), ring = s * s / 4e-5 * fall;
  const Vec3 e = s > 0 ? (1 / s) * r : Vec3{};
  return dimple(x, c, z, {}) + fall * q + 0.3 * ring * dot(grain, q) * grain +
         0.2 * ring * dot(grain, e) * dot(grain, e) * q +
         (0.2 * ring + 20 * s * fall * dot(grain, e)) * dot(grain, q) * kDown;
}

TEST_F(Middle, OfALateralDeflectionHasWhatDiffersBetweenDirections) {
  const LocalPart local(skin_, normals_, knots_, frame_);
  const Vec3 second = cross(kDown, frame_.tangent);
  Eigen::VectorXf u = sampled(lopsided, 0, frame_.tangent), v = sampled(lopsided, 0, second);
  const LocalPart::Lateral taken = local.take_lateral(u, v);
  EXPECT_LT(largest(u), 0.02);
  EXPECT_LT(largest(v), 0.02);
  // Along n at 5 mm, for the first tangent: 0.2 (s/6.3 mm)^2 e^-(s/6.3 mm)^2 cos 0.5 on average.
  const double fall = std::exp(-25.0 / 40), expected = 0.2 * 25 / 40 * fall * std::cos(0.5);
  EXPECT_NEAR(static_cast<double>(taken.anisotropic[2 * kHarmonics * knots_.size() + 5]), expected,
              0.01);
}

TEST_F(Middle, OfARigidMotionIsNothing) {
  const LocalPart local(skin_, normals_, knots_, frame_);
  Eigen::VectorXf u = sampled([](auto&&...) { return 0.004 * kDown; }, 0, {});
  for (const float p : local.take_press(u, 0.004)) EXPECT_NEAR(p, 0.0F, 1e-8F);
  EXPECT_NEAR(static_cast<double>(u[2]), -0.004, 1e-8);
}

TEST_F(Middle, IsOnlyOnTheSideOfTheContact) {
  // The other face of a plate 1 mm thick: within reach, facing the other way.
  std::vector<Vec3> skin = skin_, normals = normals_;
  for (const Vec3& x : skin_) {
    skin.push_back(x - Vec3{0, 0, 0.001});
    normals.push_back(-1.0 * kDown);
  }
  const LocalPart local(skin, normals, knots_, frame_);
  Eigen::VectorXf u = Eigen::VectorXf::Zero(3 * static_cast<Eigen::Index>(skin.size()));
  u.head(u.size() / 2) = sampled(dimple, 0.004, {});
  local.take_press(u, 0.004);
  EXPECT_LT(largest(u.head(u.size() / 2)), 0.02 * 0.004);
  EXPECT_EQ(largest(u.tail(u.size() / 2)), 0);
}

}  // namespace
}  // namespace palpate::fitting
