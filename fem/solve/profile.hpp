// SPDX-License-Identifier: AGPL-3.0-or-later
// Where the processor time of a site goes: for the benchmarks.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace palpate::fem {

/// The parts of a site, see name_of().
enum class Part {
  SiteMesh,
  SharedSolves,
  BodyPasses,
  WindowPasses,
  WindowAnalysis,
  WindowFactor,
  WindowSolves,
  Contact,
  Vectors
};
inline constexpr std::size_t kParts = 9;

/// What a part is, for a table.
const char* name_of(Part part);

/// Processor time of each part, summed over all threads. Only the innermost part that runs is
/// counted, so that the parts have no time in common.
class Profile {
 public:
  void add(Part part, std::int64_t nanoseconds) {
    spent_[static_cast<std::size_t>(part)] += nanoseconds;
  }
  void count(Part part) { ++times_[static_cast<std::size_t>(part)]; }
  double seconds(Part part) const {
    return 1e-9 * static_cast<double>(spent_[static_cast<std::size_t>(part)].load());
  }
  /// How often the part began.
  std::int64_t times(Part part) const { return times_[static_cast<std::size_t>(part)].load(); }

 private:
  std::array<std::atomic<std::int64_t>, kParts> spent_{}, times_{};
};

/// Where the timers add up; null, as it is without a benchmark, when nothing is timed. To be set
/// while no site is being solved.
inline Profile* active_profile = nullptr;

/// Counts the processor time of its scope to a part, less that of the timers inside. Without an
/// active profile it reads no clock.
class PartTimer {
 public:
  explicit PartTimer(Part part) : part_(part) {
    if (active_profile != nullptr) start();
  }
  ~PartTimer() {
    if (started_ >= 0) stop();
  }
  PartTimer(const PartTimer&) = delete;
  PartTimer& operator=(const PartTimer&) = delete;

 private:
  void start();
  void stop();

  Part part_;
  PartTimer* outer_ = nullptr;
  std::int64_t started_ = -1;  ///< ns; -1: not timed
};

}  // namespace palpate::fem
