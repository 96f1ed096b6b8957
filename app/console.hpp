// SPDX-License-Identifier: AGPL-3.0-or-later
// What the user sees: lines of text, and the progress of long work. Everything here goes to the
// standard output; the standard error is for the one line of an error.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::app {

void print_line(std::string_view line);

template <class... Args>
void say(fmt::format_string<Args...> format, Args&&... args) {
  print_line(fmt::format(format, std::forward<Args>(args)...));
}

std::string duration_text(double seconds);  ///< "42 s", "3 min 07 s", "2 h 15 min"

/// Progress of a campaign: a bar on a terminal, a line now and then otherwise.
/// Not thread-safe: the campaign tells its progress from one thread at a time.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(std::string label);
  /// `running` sites count half: the estimate of the time left would else wait for the first wave.
  /// `known` of those done took no time: they were there before.
  void show(std::int64_t done, std::int64_t incomplete, std::int64_t running, std::int64_t total,
            std::int64_t known);

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  bool terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

}  // namespace palpate::app
