// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fitting/measurement/records/placement.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/records/robot_log.hpp"

namespace palpate::measured {
namespace {

/// Fiducials register any frame of the robot with the body; forces rotate with it.
TEST(Placement, FiducialsRegisterTheLogWithTheBody) {
  const double a = 0.7, b = -1.1;
  const auto to_robot = [&](const Vec3& v) {
    const Vec3 w{std::cos(a) * v[0] - std::sin(a) * v[1], std::sin(a) * v[0] + std::cos(a) * v[1],
                 v[2]};
    return Vec3{w[0], std::cos(b) * w[1] - std::sin(b) * w[2],
                std::sin(b) * w[1] + std::cos(b) * w[2]};
  };
  const Vec3 origin{0.4, -0.3, 0.25};
  std::vector<Fiducial> fiducials;
  for (const Vec3& x :
       {Vec3{0.05, 0, 0}, Vec3{-0.05, 0.01, 0}, Vec3{0, 0.06, 0.01}, Vec3{0.02, -0.05, -0.02}}) {
    fiducials.push_back({to_robot(x) + origin, x});
  }
  const Registration registration = register_fiducials(fiducials, "sidecar");
  EXPECT_LT(registration.rms, 1e-12);
  const RobotLog plain = log_of({}, 5);
  RobotLog log = plain;
  for (std::size_t i = 0; i < log.tip.size(); ++i) {
    log.tip[i] = registration.motion(to_robot(log.tip[i]) + origin);
    log.force[i] = registration.motion.rotate(to_robot(log.force[i]));
    EXPECT_NEAR(norm(log.tip[i] - plain.tip[i]), 0, 1e-12);
    EXPECT_NEAR(norm(log.force[i] - plain.force[i]), 0, 1e-12);
  }
  fiducials[0].body[0] += 0.002;
  const Registration off = register_fiducials(fiducials, "sidecar");
  EXPECT_GT(off.rms, 0.0002);
  EXPECT_LT(off.rms, 0.002);
}

TEST(Placement, AMirroredSetOfFiducialsIsNotTurnedIntoAMirror) {
  std::vector<Fiducial> fiducials;
  for (const Vec3& x :
       {Vec3{0.05, 0, 0.01}, Vec3{-0.05, 0.01, 0}, Vec3{0, 0.06, -0.02}, Vec3{0.02, -0.05, 0.03}}) {
    fiducials.push_back({{-x[0], x[1], x[2]}, x});
  }
  const RigidMotion motion = register_fiducials(fiducials, "s").motion;
  EXPECT_NEAR(dot(cross(motion.rows[0], motion.rows[1]), motion.rows[2]), 1, 1e-12);
}

TEST(Placement, TheNearestSiteIsWithinTheTolerance) {
  const NearestSite site = nearest_site(plate(), {0.001, 0, 0.002}, 0.003, "s");
  EXPECT_EQ(site.vertex, 0);
  EXPECT_NEAR(site.distance, std::sqrt(5e-6), 1e-12);
  EXPECT_THROW(nearest_site(plate(), {0.001, 0, 0.002}, 0.002, "s"), Error);
}

}  // namespace
}  // namespace palpate::measured
