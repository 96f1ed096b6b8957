// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/console.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "app/pipeline/events.hpp"

namespace palpate::app {
namespace {

constexpr double kSecondsBetweenLines = 10;
constexpr double kSecondsBetweenBars = 0.2;

std::string bar(double fraction) {
  constexpr int width = 30;
  const int filled = static_cast<int>(std::lround(fraction * width));
  return std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(width - filled), '.');
}

}  // namespace

void TextOutput::line(std::string_view text) const {
  write(std::string(text) + '\n');
}

TextOutput standard_output() {
  return {[](std::string_view text) {
            std::fwrite(text.data(), 1, text.size(), stdout);
            std::fflush(stdout);
          },
          isatty(STDOUT_FILENO) != 0};
}

void print_line(std::string_view line) {
  standard_output().line(line);
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(std::fmax(0, seconds)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

void ProgressDisplay::show(const Progress& p) {
  const Clock::time_point now = Clock::now();
  const double since_last = std::chrono::duration<double>(now - last_).count();
  const double interval = output_.terminal ? kSecondsBetweenBars : kSecondsBetweenLines;
  const bool finished = p.done >= p.total;
  if (!finished && since_last < interval) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const auto done = static_cast<double>(p.done), total = static_cast<double>(p.total),
             known = static_cast<double>(p.known), running = static_cast<double>(p.running);
  const double work = (done - known + 0.5 * running) / std::fmax(1, total - known);
  const std::string time = finished           ? duration_text(elapsed)
                           : p.done > p.known ? duration_text(elapsed * (1 - work) / work) + " left"
                                              : std::string("remaining time unknown");
  const std::string text =
      fmt::format("{}: {} of {} sites, {} incomplete, {}", label_, p.done, p.total, p.failed, time);
  if (!output_.terminal) return output_.line(text);
  const double fraction = p.total > 0 ? done / total : 1;
  output_.write(fmt::format("\r[{}] {}\x1b[K{}", bar(fraction), text, finished ? "\n" : ""));
}

}  // namespace palpate::app
