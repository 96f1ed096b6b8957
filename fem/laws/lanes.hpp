// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace palpate::fem {

/// Elements are evaluated eight at a time, one in each lane of a vector register.
inline constexpr int kLanes = 8;
using Lanes = Eigen::Array<double, kLanes, 1>;

/// Zero of a scalar type: Lanes would take a number for a size.
template <class T>
T zero_of() {
  return T(0.0);
}
template <>
inline Lanes zero_of<Lanes>() {
  return Lanes::Zero();
}

}  // namespace palpate::fem
