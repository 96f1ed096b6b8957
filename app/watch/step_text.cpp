// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/watch/step_text.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>

#include "format/error.hpp"
#include "format/step_columns.hpp"

namespace palpate::app {
namespace {

constexpr std::size_t kColumns = 22;
constexpr std::size_t kLongestLine = 2000;  // characters

[[noreturn]] void refuse_line(std::uint64_t number, const std::string& problem) {
  refuse("line " + std::to_string(number) + " of the steps", problem,
         std::string("begin with the line \"") + kStepColumns + "\" and print a step a line");
}

/// The numbers between the commas of a line.
std::array<double, kColumns> numbers_of(std::string_view line, std::uint64_t number) {
  std::array<double, kColumns> out{};
  for (std::size_t i = 0; i < kColumns; ++i) {
    const std::size_t comma = std::min(line.find(','), line.size());
    const std::string_view word = line.substr(0, comma);
    const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), out[i]);
    if (failed != std::errc{} || end != word.data() + word.size())
      refuse_line(number, "column " + std::to_string(i + 1) + " is no number: \"" +
                              std::string(word) + "\"");
    if ((comma == line.size()) != (i + 1 == kColumns))
      refuse_line(number, "has not " + std::to_string(kColumns) + " columns");
    line.remove_prefix(std::min(comma + 1, line.size()));
  }
  return out;
}

RecordedStep step_of(const std::array<double, kColumns>& c, std::uint64_t number) {
  const auto whole = [&](double value, double low, double high) {
    if (!(value >= low && value <= high))
      refuse_line(number, "has a whole number that is out of range");
    return value;
  };
  const auto vector = [&](std::size_t i) { return Vec3{c[i], c[i + 1], c[i + 2]}; };
  RecordedStep step;
  step.time_ns = static_cast<std::int64_t>(whole(c[0], -9e18, 9e18));
  step.position = vector(1);
  step.velocity = vector(4);
  step.force = vector(7);
  step.contact_point = vector(10);
  step.depth = c[13];
  step.lateral = c[14];
  step.offset = c[15];
  step.energy = c[16];
  step.tank = c[17];
  step.absorbed = c[18];
  step.element = static_cast<std::int32_t>(whole(c[19], -1, 2147483647));
  step.status = static_cast<std::uint32_t>(whole(c[20], 0, 4294967295));
  step.latency_ns = static_cast<std::int64_t>(whole(c[21], -9e18, 9e18));
  return step;
}

}  // namespace

/// False where there is nothing now.
bool StepText::read_some() {
  pollfd waiting{descriptor_, POLLIN, 0};
  if (at_end_ || ::poll(&waiting, 1, 0) <= 0) return false;
  std::array<char, 65536> bytes;
  const ssize_t size = ::read(descriptor_, bytes.data(), bytes.size());
  if (size <= 0) {
    at_end_ = true;
    return false;
  }
  left_.append(bytes.data(), static_cast<std::size_t>(size));
  return true;
}

void StepText::take_line(std::string_view line, SessionNews& news) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  if (++lines_ > 1) {
    news.steps.push_back(step_of(numbers_of(line, lines_), lines_));
    return;
  }
  if (line != kStepColumns) refuse_line(lines_, "is not the line of the columns");
  news.begun = heading_;
}

SessionNews StepText::poll() {
  SessionNews news;
  while (news.steps.size() < kMostNews && read_some()) {
    std::size_t begin = 0;
    for (std::size_t end; (end = left_.find('\n', begin)) != std::string::npos; begin = end + 1)
      take_line(std::string_view(left_).substr(begin, end - begin), news);
    left_.erase(0, begin);
    if (left_.size() > kLongestLine) refuse_line(lines_ + 1, "is too long");
  }
  news.ended = at_end_ && !std::exchange(told_, at_end_);
  return news;
}

}  // namespace palpate::app
