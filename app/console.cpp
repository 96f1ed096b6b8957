// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "app/pipeline/events.hpp"
#include "app/wrapped_text.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

constexpr double kSecondsBetweenLines = 10;
constexpr double kSecondsBetweenBars = 0.2;
constexpr int kBarWidth = 30, kSmallestBar = 10;  // columns
constexpr std::size_t kHanging = 2;               // blanks before what follows a break

constexpr std::string_view kRed = "\x1b[1;31m", kYellow = "\x1b[1;33m", kPlain = "\x1b[0m";

/// errno of the first write to the standard output that failed.
int output_error = 0;

void write_to(FILE* stream, std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  if ((std::fflush(stream) != 0 || !written) && stream == stdout && output_error == 0)
    output_error = errno;
}

bool colours_wanted() {
  const char* refused = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return (refused == nullptr || *refused == '\0') && terminal != nullptr &&
         std::string_view(terminal) != "dumb";
}

int columns_of(int descriptor) {
  winsize size{};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

TextOutput output_to(FILE* stream, int descriptor) {
  TextOutput output;
  output.write = [stream](std::string_view text) { write_to(stream, text); };
  output.terminal = isatty(descriptor) != 0;
  output.columns = output.terminal ? columns_of(descriptor) : 0;
  output.colour = output.terminal && colours_wanted();
  return output;
}

std::string bar(double fraction, int width) {
  const int filled = static_cast<int>(std::lround(fraction * width));
  return std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(width - filled), '.');
}

std::string marked_line(std::string_view mark, std::string_view colour, std::string_view text,
                        bool coloured) {
  std::string line = coloured ? fmt::format("{}{}:{} {}", colour, mark, kPlain, text)
                              : fmt::format("{}: {}", mark, text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

}  // namespace

void TextOutput::line(std::string_view text) const {
  write(wrapped(text, static_cast<std::size_t>(terminal ? std::max(0, columns) : 0), kHanging) +
        '\n');
}

Console& console() {
  static Console here{output_to(stdout, STDOUT_FILENO), output_to(stderr, STDERR_FILENO)};
  return here;
}

void print_line(std::string_view line) {
  console().out.write(std::string(line) + '\n');
}

void print_text(std::string_view text) {
  console().out.line(text);
}

std::string error_line(std::string_view text, bool colour) {
  return marked_line("error", kRed, text, colour);
}

std::string warning_line(std::string_view text, bool colour) {
  return marked_line("warning", kYellow, text, colour);
}

void warn(std::string_view text) {
  console().err.line(warning_line(text, console().err.colour));
}

void report_failed_writes() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool all_printed() {
  return output_error == 0 || output_error == EPIPE;
}

std::string bar_line(double fraction, std::string_view text, int columns) {
  constexpr int frame = 3;  // brackets and a blank
  const int length = static_cast<int>(text.size());
  const int room = columns > 0 ? columns - 1 - length - frame : kBarWidth;  // the last column wraps
  if (room >= kSmallestBar)
    return fmt::format("[{}] {}", bar(fraction, std::min(room, kBarWidth)), text);
  return std::string(text.substr(0, static_cast<std::size_t>(std::max(1, columns - 1))));
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(std::fmax(0, seconds)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

bool ProgressDisplay::is_due(Clock::time_point now) const {
  const double since_last = std::chrono::duration<double>(now - last_).count();
  return since_last >= (output_.terminal ? kSecondsBetweenBars : kSecondsBetweenLines);
}

void ProgressDisplay::show(const PreloadStep& p) {
  const Clock::time_point now = Clock::now();
  if (!is_due(now)) return;
  last_ = now;
  std::string text =
      fmt::format("{}: {}, step {}", label_,
                  p.shapes > 0 ? "shape without weight" : "equilibrium under the weight", p.steps);
  if (p.shapes > 0) text += ", " + count_text(p.shapes, "shape") + " tried";
  if (p.carried > 0) text += fmt::format(", {:.3g} % of the weight reached", 100 * p.carried);
  if (!output_.terminal) return output_.line(text);
  const std::string cut = text.substr(
      0, output_.columns > 0 ? static_cast<std::size_t>(output_.columns - 1) : std::string::npos);
  output_.write(fmt::format("\r{}\x1b[K", cut));
  bar_open_ = true;
}

void ProgressDisplay::show(const Progress& p) {
  const Clock::time_point now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const bool starts = p.done <= p.known && p.running == 0;
  if (starts) return remaining_.begin(elapsed);
  remaining_.update(elapsed, p.done - p.known, p.total - p.known, p.sites);
  const bool finished = p.done >= p.total;
  if (!output_.terminal && p.between_sites) return;
  if (!finished && !is_due(now)) return;
  last_ = now;
  const std::optional<double> left = remaining_.left(elapsed);
  const std::string time = finished ? duration_text(elapsed)
                           : left   ? duration_text(*left) + " left"
                                    : std::string("remaining time unknown");
  const std::string text =
      fmt::format("{}: {} of {} sites, {} incomplete, {}", label_, p.done, p.total, p.failed, time);
  if (!output_.terminal) return output_.line(text);
  double sites = static_cast<double>(p.done);
  for (const SiteProgress& site : p.sites) sites += site.fraction;
  const double fraction = p.total > 0 ? std::min(1.0, sites / static_cast<double>(p.total)) : 1;
  output_.write(
      fmt::format("\r{}\x1b[K{}", bar_line(fraction, text, output_.columns), finished ? "\n" : ""));
  bar_open_ = !finished;
}

void ProgressDisplay::interrupt() {
  if (bar_open_) output_.write("\n");
  bar_open_ = false;
}

}  // namespace palpate::app
