// SPDX-License-Identifier: AGPL-3.0-or-later
// What the report shows of a session, gathered step by step.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "format/recording.hpp"

namespace palpate::report {

/// Counts and extremes of all steps, and the steps worth drawing: the extremes of force, depth,
/// energy and latency in each of `buckets` equal runs of steps, and every start and end of contact
/// up to `buckets`. Takes 8 bytes a step, for the latencies, besides what is drawn.
class SessionDigest {
 public:
  static constexpr std::size_t kBuckets = 600;  ///< about the width in pixels of a plot over time

  /// `steps`: how many will be added.
  SessionDigest(RecordingHeading heading, std::uint64_t steps, std::size_t buckets = kBuckets);

  void add(const RecordedStep& step);

  const RecordingHeading& heading() const { return heading_; }
  std::size_t steps() const { return count_; }
  double duration() const { return 1e-9 * static_cast<double>(last_.time_ns); }  ///< s
  double max_force() const { return max_force_; }                                ///< N
  /// Steps with a bit of palpate.h.
  std::size_t count(std::uint32_t bit) const;
  const std::vector<double>& latencies() const { return latencies_; }  ///< s, where known
  /// Passive as long as the work absorbed covers what is stored: least absorbed - energy - tank, J,
  /// and when, s.
  double least_margin() const { return least_margin_; }
  double least_margin_time() const { return least_margin_time_; }
  /// In the order of time.
  std::vector<RecordedStep> drawn() const;

 private:
  using Numbered = std::pair<std::size_t, RecordedStep>;
  void note_extremes(const RecordedStep& step);
  void close_bucket(std::vector<Numbered>& kept) const;

  RecordingHeading heading_;
  std::size_t length_, most_changes_;  ///< steps of a bucket; changes of contact that are kept
  std::size_t count_ = 0, changes_ = 0, in_bucket_ = 0;
  double max_force_ = 0;
  double least_margin_ = std::numeric_limits<double>::infinity(), least_margin_time_ = 0;
  std::array<std::size_t, 32> bits_{};
  std::vector<double> latencies_;
  RecordedStep last_;
  std::array<Numbered, 4> lowest_, highest_;  ///< of the bucket under way
  std::vector<Numbered> kept_;
};

/// Of all that a reader has left.
SessionDigest digest(RecordingReader& reader);
SessionDigest digest(const Recording& recording);

}  // namespace palpate::report
