// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/serial_chain.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "format/error.hpp"

namespace palpate::runtime {
namespace {

/// v turned about a unit axis by an angle (rad) [Rodrigues].
Vec3 turned(const Vec3& v, const Vec3& axis, double angle) noexcept {
  const double c = std::cos(angle);
  return c * v + std::sin(angle) * cross(axis, v) + ((1 - c) * dot(axis, v)) * axis;
}

[[noreturn]] void reject(const std::string& problem) {
  throw Error(ErrorKind::Configuration, "lab-built device", problem, "correct its configuration");
}

}  // namespace

SerialChain::SerialChain(std::vector<Joint> joints, const Vec3& home)
    : joints_(std::move(joints)), home_(home) {
  if (joints_.empty() || joints_.size() > kMostJoints) {
    reject("it has " + std::to_string(joints_.size()) + " joints, not 1 to " +
           std::to_string(kMostJoints));
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (!(std::abs(norm(joints_[j].axis) - 1) < 1e-6)) {
      reject("the axis of joint " + std::to_string(j) + " is not a unit vector");
    }
  }
}

/// From the last joint to the first: each joint moves the tip and the columns found so far.
SerialChain::Pose SerialChain::at(const std::array<double, kMostJoints>& q) const noexcept {
  Pose pose;
  pose.tip = home_;
  for (std::size_t j = joints_.size(); j-- > 0;) {
    const Joint& joint = joints_[j];
    if (joint.kind == JointKind::Prismatic) {
      pose.tip = pose.tip + q[j] * joint.axis;
      pose.column[j] = joint.axis;
      continue;
    }
    pose.tip = joint.point + turned(pose.tip - joint.point, joint.axis, q[j]);
    pose.column[j] = cross(joint.axis, pose.tip - joint.point);
    for (std::size_t k = j + 1; k < joints_.size(); ++k) {
      pose.column[k] = turned(pose.column[k], joint.axis, q[j]);
    }
  }
  return pose;
}

}  // namespace palpate::runtime
