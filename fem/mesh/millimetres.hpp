// SPDX-License-Identifier: AGPL-3.0-or-later
// Lengths and places as they stand in the reasons of paths that end early.
#pragma once

#include <Eigen/Core>
#include <string>

namespace palpate::fem {

/// "2.500 mm", of metres.
std::string in_millimetres(double metres);
/// "(1.0, -2.5, 30.0) mm", of metres.
std::string point_in_millimetres(const Eigen::Vector3d& X);

}  // namespace palpate::fem
