// SPDX-License-Identifier: Apache-2.0
// The triangles that the search delivers to the force loop.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/surface.hpp"

namespace palpate::runtime {

/// The triangles on which the force loop may find a collision and over which it may slide until the
/// next delivery [Mahvash & Hayward 2005, VI-A]. Its size is fixed, so that it passes through a
/// queue without allocation.
class Delivery {
 public:
  static constexpr std::size_t kMost = 256;

  /// Replaces the triangles by the first kMost of `elements`, in any order.
  void assign(std::span<const std::int32_t> elements) noexcept {
    count_ = std::min(elements.size(), kMost);
    std::copy_n(elements.begin(), count_, elements_.begin());
    std::sort(elements_.begin(), elements_.begin() + static_cast<std::ptrdiff_t>(count_));
  }

  bool holds(std::int32_t m) const noexcept {
    const auto all = elements();
    return std::binary_search(all.begin(), all.end(), m);
  }
  std::span<const std::int32_t> elements() const noexcept { return {elements_.data(), count_}; }

  /// Where the tip crossed from outside to inside between the last two searches; its element is
  /// kNoElement when it did not. For a tip that was faster than the delivery of triangles.
  SurfacePoint entry;

 private:
  std::array<std::int32_t, kMost> elements_{};
  std::size_t count_ = 0;
};

}  // namespace palpate::runtime
