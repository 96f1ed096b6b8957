// SPDX-License-Identifier: Apache-2.0
// Kinematics of a lab-built device: position of the tip for given joints, and its Jacobian.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::runtime {

enum class JointKind : unsigned char { Revolute, Prismatic };

/// A joint in the home position of the device: all joint coordinates zero.
struct Joint {
  JointKind kind = JointKind::Revolute;
  Vec3 axis{};   ///< unit
  Vec3 point{};  ///< m, on the axis; not used by a prismatic joint
};

/// A chain of joints from the base to the tip. The position of the tip follows from the product of
/// exponentials [Murray, Li & Sastry 1994, ch. 3].
class SerialChain {
 public:
  static constexpr std::size_t kMostJoints = 6;

  /// home: the tip with all coordinates zero, m. @throws Error(Configuration) for no joint, more
  /// than kMostJoints, or an axis that is not of unit length.
  SerialChain(std::vector<Joint> joints, const Vec3& home);

  struct Pose {
    Vec3 tip{};                              ///< m
    std::array<Vec3, kMostJoints> column{};  ///< dtip/dq_j, m/rad or 1
  };
  /// q: rad or m, one for each joint. noexcept, allocation-free.
  Pose at(const std::array<double, kMostJoints>& q) const noexcept;
  std::size_t size() const noexcept { return joints_.size(); }
  JointKind kind(std::size_t j) const noexcept { return joints_[j].kind; }

 private:
  std::vector<Joint> joints_;
  Vec3 home_;
};

}  // namespace palpate::runtime
