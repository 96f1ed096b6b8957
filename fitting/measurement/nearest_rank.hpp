// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpate::fitting {

/// Index of a quantile among n > 0 sorted values by the nearest rank: the least value that at least
/// `fraction` (0 to 1) of them do not exceed.
inline std::size_t nearest_rank(std::size_t n, double fraction) {
  const double rank = std::ceil(fraction * static_cast<double>(n));
  return static_cast<std::size_t>(std::max(1.0, rank)) - 1;
}

}  // namespace palpate::fitting
