// SPDX-License-Identifier: Apache-2.0
// Values with a meaning of their own.
#pragma once

#include <limits>

namespace palpate {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kUnknown =
    std::numeric_limits<double>::quiet_NaN();  ///< nobody has stated it

}  // namespace palpate
