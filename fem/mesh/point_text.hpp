// SPDX-License-Identifier: AGPL-3.0-or-later
// Points as text in messages.
#pragma once

#include <Eigen/Core>
#include <string>

namespace palpate::fem {

/// Metres as "(1, -2.5, 30) mm", in the unit of position_text.
std::string point_text(const Eigen::Vector3d& X);

}  // namespace palpate::fem
