// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpate::fitting {

/// Index of the quantile `share` (0 to 1) among n > 0 sorted values, by the nearest rank: the least
/// value that at least this share of them does not exceed.
inline std::size_t nearest_rank(std::size_t n, double share) {
  const double rank = std::ceil(share * static_cast<double>(n));
  return static_cast<std::size_t>(std::max(1.0, rank)) - 1;
}

}  // namespace palpate::fitting
