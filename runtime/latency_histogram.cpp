// SPDX-License-Identifier: Apache-2.0
#include "runtime/latency_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate::runtime {

/// The octave is the position of the highest bit, the eighth the next three bits: equal steps of
/// the duration within an octave.
std::size_t LatencyHistogram::bucket_of(std::int64_t ns) noexcept {
  const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 1));
  const auto octave = static_cast<std::size_t>(std::bit_width(value) - 1);
  const std::uint64_t rest = value - (std::uint64_t{1} << octave);
  const auto eighth =
      static_cast<std::size_t>(octave >= 3 ? rest >> (octave - 3) : rest << (3 - octave));
  return std::min(octave * kPerOctave + eighth, kBuckets - 1);
}

double LatencyHistogram::upper_end(std::size_t bucket) noexcept {
  const auto octave = static_cast<int>(bucket / kPerOctave);
  const auto eighth = static_cast<double>(bucket % kPerOctave);
  return std::ldexp(1 + (eighth + 1) / kPerOctave, octave);
}

void LatencyHistogram::add(std::int64_t ns) noexcept {
  ++buckets_[bucket_of(ns)];
  ++count_;
  largest_ = std::max(largest_, ns);
}

double LatencyHistogram::quantile(double fraction) const noexcept {
  const double wanted = fraction * static_cast<double>(count_);
  double seen = 0;
  for (std::size_t b = 0; b < kBuckets; ++b) {
    seen += static_cast<double>(buckets_[b]);
    if (seen >= wanted && seen > 0) {
      return std::min(upper_end(b), static_cast<double>(largest_));
    }
  }
  return 0;
}

}  // namespace palpate::runtime
