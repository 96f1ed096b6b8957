// SPDX-License-Identifier: AGPL-3.0-or-later
// Lengths and points as text in messages.
#pragma once

#include <Eigen/Core>
#include <string>

namespace palpate::fem {

/// Metres as "2.500 mm".
std::string in_millimetres(double metres);
/// Metres as "(1.0, -2.5, 30.0) mm".
std::string point_in_millimetres(const Eigen::Vector3d& X);

}  // namespace palpate::fem
