// SPDX-License-Identifier: AGPL-3.0-or-later
// The factor of a body that has bent, against Hooke's law and the factor at rest.
#include "fem/solve/turned_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/unit/fem/solve/pressed_body.hpp"

namespace palpate::fem {
namespace {

/// A load turned with the body displaces it as the load at rest does, turned.
TEST(TurnedFactor, SolvesInTheFrameOfABodyThatHasRotated) {
  PressedBody p(2 * kToolRadius);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(2, 1, -1).normalized()).toRotationMatrix();
  const auto rotated = [&](const Eigen::VectorXd& v) {
    const Eigen::Matrix3Xd nodes =
        R * Eigen::Map<const Eigen::Matrix3Xd>(v.data(), 3, v.size() / 3);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(nodes.data(), v.size()));
  };
  const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(p.whole.pattern().n, -1, 2);
  Eigen::VectorXd at_rest;
  p.rest_solve(load, at_rest);
  const Displacement turned = (R - Eigen::Matrix3d::Identity()) * p.whole.mesh().X;
  for (const auto& [precision, tolerance] :
       {std::pair(Precision::Single, 1e-3), std::pair(Precision::Double, 1e-9)}) {
    TurnedFactor factor(p.whole, nested_dissection(p.whole.pattern()), precision, turned);
    Eigen::VectorXd x;
    factor.solve(rotated(load), x);
    EXPECT_LT((x - rotated(at_rest)).norm(), tolerance * x.norm());
  }
}

}  // namespace
}  // namespace palpate::fem
