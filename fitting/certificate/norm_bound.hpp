// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <array>

#include "fitting/certificate/range.hpp"

namespace palpate::fitting {

/// Upper bound of the spectral norm of all 3 x 3 matrices with entries in these ranges: the norm of
/// the middle plus the Frobenius norm of the radii. To be multiplied by kRoundingFactor. Infinite
/// where an entry is.
double norm_bound(const std::array<std::array<Range, 3>, 3>& entry);

}  // namespace palpate::fitting
