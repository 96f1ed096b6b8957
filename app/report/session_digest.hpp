// SPDX-License-Identifier: AGPL-3.0-or-later
// Data of a session for the report, accumulated step by step.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "format/recording.hpp"

namespace palpate::report {

/// Counts and extremes of all steps, and the steps to draw: the extremes of force, depth,
/// energy and latency in each of `buckets` equal runs of steps, and every start and end of contact
/// up to `buckets`. Memory: 8 bytes a step and the drawn steps.
class SessionDigest {
 public:
  static constexpr std::size_t kBuckets = 600;  ///< about the width in pixels of a plot over time

  /// @param steps  number of steps that will be added
  SessionDigest(RecordingHeading heading, std::uint64_t steps, std::size_t buckets = kBuckets);

  void add(const RecordedStep& step);

  const RecordingHeading& heading() const { return heading_; }
  std::size_t steps() const { return count_; }
  double duration() const { return 1e-9 * static_cast<double>(last_.time_ns); }  ///< s
  double max_force() const { return max_force_; }                                ///< N
  /// Number of steps with a status bit of palpate.h.
  std::size_t count(std::uint32_t bit) const;
  const std::vector<double>& latencies() const { return latencies_; }  ///< s, where known
  /// Smallest absorbed - energy - tank, J, and its time, s. The session is passive if it is >= 0.
  double least_margin() const { return least_margin_; }
  double least_margin_time() const { return least_margin_time_; }
  /// In the order of time.
  std::vector<RecordedStep> drawn() const;

 private:
  using Numbered = std::pair<std::size_t, RecordedStep>;
  void note_extremes(const RecordedStep& step);
  void close_bucket(std::vector<Numbered>& drawn) const;

  RecordingHeading heading_;
  std::size_t length_,
      most_changes_;  ///< steps of a bucket; largest number of drawn contact changes
  std::size_t count_ = 0, changes_ = 0, in_bucket_ = 0;
  double max_force_ = 0;
  double least_margin_ = std::numeric_limits<double>::infinity(), least_margin_time_ = 0;
  std::array<std::size_t, 32> bits_{};
  std::vector<double> latencies_;
  RecordedStep last_;
  std::array<Numbered, 4> lowest_, highest_;  ///< of the current bucket
  std::vector<Numbered> drawn_;
};

/// Digest of the remaining steps of a reader.
SessionDigest digest(RecordingReader& reader);
SessionDigest digest(const Recording& recording);

}  // namespace palpate::report
