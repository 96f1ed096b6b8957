// SPDX-License-Identifier: AGPL-3.0-or-later
// The steps of a program's own force loop, as it prints them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "app/watch/session_news.hpp"

namespace palpate::app {

/// Lines of text with the columns of kStepColumns, which are the first line; numbers between
/// commas, SI. A pipe or a file that is still being written. Not thread-safe.
class StepText {
 public:
  /// Reads from this descriptor, which the caller closes, and never waits for it.
  StepText(int descriptor, RecordingHeading heading)
      : descriptor_(descriptor), heading_(std::move(heading)) {}

  /// What has come since the last call; `ended`: the end of the text. @throws Error(Configuration)
  /// for a line that is no step.
  SessionNews poll();

 private:
  bool read_some();
  void take_line(std::string_view line, SessionNews& news);

  int descriptor_;
  RecordingHeading heading_;
  std::string left_;
  std::uint64_t lines_ = 0;
  bool at_end_ = false, told_ = false;
};

}  // namespace palpate::app
