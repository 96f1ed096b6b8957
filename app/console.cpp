// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/console.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace palpate::app {
namespace {

constexpr double kSecondsBetweenLines = 10;
constexpr double kSecondsBetweenBars = 0.2;

std::string bar(double share) {
  constexpr int width = 30;
  const int filled = static_cast<int>(std::lround(share * width));
  return std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(width - filled), '.');
}

}  // namespace

void print_line(std::string_view line) {
  std::fwrite(line.data(), 1, line.size(), stdout);
  std::fputc('\n', stdout);
  std::fflush(stdout);
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(std::fmax(0, seconds)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

ProgressDisplay::ProgressDisplay(std::string label)
    : label_(std::move(label)), terminal_(isatty(STDOUT_FILENO) != 0) {}

void ProgressDisplay::show(std::int64_t done, std::int64_t incomplete, std::int64_t running,
                           std::int64_t total, std::int64_t known) {
  const Clock::time_point now = Clock::now();
  const double since_last = std::chrono::duration<double>(now - last_).count();
  const bool finished = done >= total;
  if (!finished && since_last < (terminal_ ? kSecondsBetweenBars : kSecondsBetweenLines)) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double share = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1;
  const double work = (static_cast<double>(done - known) + 0.5 * static_cast<double>(running)) /
                      std::fmax(1, static_cast<double>(total - known));
  const std::string time = finished       ? duration_text(elapsed)
                           : done > known ? duration_text(elapsed * (1 - work) / work) + " left"
                                          : std::string("time left unknown");
  const std::string text =
      fmt::format("{}: {} of {} sites, {} incomplete, {}", label_, done, total, incomplete, time);
  if (!terminal_) return print_line(text);
  fmt::print("\r[{}] {}\x1b[K{}", bar(share), text, finished ? "\n" : "");
  std::fflush(stdout);
}

}  // namespace palpate::app
