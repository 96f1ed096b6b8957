// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "format/vec3.hpp"

namespace palpate {

/// Positions of the points along a space-filling curve, on which near points are mostly near each
/// other (Z order; G. M. Morton 1966).
inline std::vector<std::size_t> space_filling_order(const std::vector<Vec3>& points) {
  constexpr std::size_t kBits = 20;  // an axis
  if (points.empty()) return {};
  Vec3 low = points.front(), high = low;
  for (const Vec3& x : points)
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], x[i]);
      high[i] = std::max(high[i], x[i]);
    }
  std::vector<std::pair<std::uint64_t, std::size_t>> place;
  place.reserve(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    std::uint64_t code = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double extent = std::max(high[i] - low[i], 1e-12);
      const auto cell =
          static_cast<std::uint64_t>((points[v][i] - low[i]) / extent * ((1U << kBits) - 1));
      for (std::size_t bit = 0; bit < kBits; ++bit) code |= ((cell >> bit) & 1U) << (3 * bit + i);
    }
    place.emplace_back(code, v);
  }
  std::sort(place.begin(), place.end());
  std::vector<std::size_t> order;
  order.reserve(place.size());
  for (const auto& [code, v] : place) order.push_back(v);
  return order;
}

}  // namespace palpate
