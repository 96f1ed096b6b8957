// SPDX-License-Identifier: AGPL-3.0-or-later
// Text for people, on the standard output. The standard error is for the one line of an error.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

namespace palpate::app {

struct Progress;

/// Where text goes.
struct TextOutput {
  std::function<void(std::string_view)> write;  ///< text as it is; must flush
  bool terminal = false;                        ///< understands carriage return and erasing

  void line(std::string_view text) const;
};

TextOutput standard_output();

void print_line(std::string_view line);  ///< on the standard output

template <class... Args>
void say(fmt::format_string<Args...> format, Args&&... args) {
  print_line(fmt::format(format, std::forward<Args>(args)...));
}

std::string duration_text(double seconds);  ///< "42 s", "3 min 07 s", "2 h 15 min"

/// Progress of a campaign: a bar on a terminal, a line every few seconds otherwise.
/// Not thread-safe.
class ProgressDisplay {
 public:
  ProgressDisplay(std::string label, TextOutput output)
      : label_(std::move(label)), output_(std::move(output)) {}
  /// The estimate of the remaining time counts running sites as half done, so that it starts with
  /// the first batch, and leaves out the sites that an earlier run computed.
  void show(const Progress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  TextOutput output_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

}  // namespace palpate::app
