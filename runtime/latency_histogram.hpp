// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate::runtime {

/// Counts durations in buckets that grow by 1/8 octave: 9 % wide, from 1 ns to 18 minutes. add() is
/// noexcept, allocation-free and constant in time. For one writer; read it when the writer has
/// stopped.
class LatencyHistogram {
 public:
  void add(std::int64_t ns) noexcept;  ///< below 1 ns counts as 1 ns

  std::uint64_t count() const noexcept { return count_; }
  std::int64_t largest() const noexcept { return largest_; }  ///< ns, exact
  /// Duration that this fraction of the samples does not exceed, ns: the upper end of its bucket.
  double quantile(double fraction) const noexcept;

 private:
  static constexpr std::size_t kPerOctave = 8;
  static constexpr std::size_t kBuckets = 40 * kPerOctave;

  static std::size_t bucket_of(std::int64_t ns) noexcept;
  static double upper_end(std::size_t bucket) noexcept;

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::int64_t largest_ = 0;
};

}  // namespace palpate::runtime
