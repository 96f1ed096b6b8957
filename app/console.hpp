// SPDX-License-Identifier: AGPL-3.0-or-later
// Text for people. Results go to the standard output, errors and warnings to the standard error.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

#include "app/remaining_time.hpp"

namespace palpate::app {

struct PreloadStep;
struct Progress;

/// Where text goes.
struct TextOutput {
  std::function<void(std::string_view)> write;  ///< text as it is; must flush
  bool terminal = false;                        ///< understands carriage return and erasing
  int columns = 0;                              ///< width of the terminal; 0: unknown
  bool colour = false;                          ///< understands the colours of ECMA-48

  /// One line; on a terminal lines that are wider than it are broken between words.
  void line(std::string_view text) const;
};

/// How much the stages print.
enum class Verbosity {
  Quiet,    ///< warnings, errors and results that were asked for
  Normal,   ///< also what is done, and progress
  Verbose,  ///< also every site
};

/// The outputs of the process.
struct Console {
  TextOutput out, err;
  Verbosity verbosity = Verbosity::Normal;
};

/// The console of this process. Colours need a terminal, no NO_COLOR in the environment
/// (no-color.org), and a TERM other than "dumb".
Console& console();

/// On the standard output as it is: for programs.
void print_line(std::string_view line);
/// On the standard output, for people: broken to the width of a terminal.
void print_text(std::string_view text);

/// A result that was asked for, which a quiet command prints too.
template <class... Args>
void answer(fmt::format_string<Args...> format, Args&&... args) {
  print_text(fmt::format(format, std::forward<Args>(args)...));
}

/// What a command does and has done.
template <class... Args>
void say(fmt::format_string<Args...> format, Args&&... args) {
  if (console().verbosity != Verbosity::Quiet) answer(format, std::forward<Args>(args)...);
}

/// "error: <text>" or "warning: <text>" on one line, the first word in colour.
std::string error_line(std::string_view text, bool colour);
std::string warning_line(std::string_view text, bool colour);

void warn(std::string_view text);  ///< on the standard error

/// Goes on when the reader of the standard output ends early, as `head` does: what is printed
/// after that is lost, and nothing else. A file over the limit of its size is a write that fails,
/// with its error, and no signal.
void report_failed_writes();

/// Whether everything that was printed on the standard output arrived. A reader that ended early
/// has what it wanted.
bool all_printed();

std::string duration_text(double seconds);  ///< "42 s", "3 min 07 s", "2 h 15 min"

/// The text after a bar, together no wider than `columns` (0: any width): the bar shrinks and
/// vanishes, then the text is cut.
std::string bar_line(double fraction, std::string_view text, int columns);

/// Progress of a campaign: a bar on a terminal, a line every few seconds otherwise.
/// Not thread-safe.
class ProgressDisplay {
 public:
  ProgressDisplay(std::string label, TextOutput output, const SiteSharing& sharing = {})
      : label_(std::move(label)), output_(std::move(output)), remaining_(sharing) {}
  /// The first progress of a campaign, before its first site, starts the clock of the estimate.
  void show(const Progress& progress);
  /// What stands before the first site.
  void show(const PreloadStep& step);
  /// Ends the line of a bar, before other text is printed.
  void interrupt();

 private:
  using Clock = std::chrono::steady_clock;

  /// Whether the last progress was shown long enough ago.
  bool is_due(Clock::time_point now) const;

  std::string label_;
  TextOutput output_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  bool bar_open_ = false;
  RemainingTime remaining_;
};

}  // namespace palpate::app
