// SPDX-License-Identifier: AGPL-3.0-or-later
// What the page of a running session is sent: each frame is complete, so that any of them may be
// left out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/watch/session_news.hpp"
#include "format/recording.hpp"

namespace palpate::app {

/// A session so far. Not thread-safe.
class LiveFrames {
 public:
  /// The digest of the library that the page draws.
  explicit LiveFrames(std::string library_sha256) : library_sha256_(std::move(library_sha256)) {}

  /// False where the news have nothing.
  bool see(const SessionNews& news);
  /// JSON of one line, SI units, positions in the frame of the body: the session with its counts,
  /// the last step, and for the plots the steps since the last call, thinned to extremes of the
  /// force.
  std::string next();

 private:
  void count(const RecordedStep& step);

  struct Counts {
    std::uint64_t steps = 0, contact = 0, beyond_depth = 0, late = 0, clamped = 0;
    double largest_force = 0;
    double least_margin = 0;  ///< J, of absorbed - energy - tank
  };

  std::string library_sha256_;
  std::optional<RecordingHeading> heading_;
  std::uint64_t session_ = 0;  ///< number of sessions that have begun
  bool running_ = false;
  Counts counts_;
  std::optional<RecordedStep> last_;
  std::vector<RecordedStep> recent_;
};

}  // namespace palpate::app
