// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/file/scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <tuple>

#include "format/error.hpp"
#include "format/text.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\f\v";

template <class Number>
std::optional<Number> number_of(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  Number value{};
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failure != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// A word as messages show it: short, and without what no terminal prints.
std::string shown(std::string_view word) {
  std::string text;
  for (const char letter : word.substr(0, 30))
    text += letter >= ' ' && letter <= '~' ? letter : '?';
  return word.size() > 30 ? text + "..." : text;
}

}  // namespace

std::optional<double> real_of(std::string_view word) {
  return number_of<double>(word);
}

std::optional<std::int64_t> integer_of(std::string_view word) {
  return number_of<std::int64_t>(word);
}

double finite_real(std::string_view word, std::string_view what, const Scanner& place) {
  const auto value = real_of(word);
  if (!value) place.refuse(text("'", shown(word), "' where ", what, " is expected"));
  if (!std::isfinite(*value)) {
    place.refuse(text(what, " that is not finite (", shown(word), ")"),
                 "correct the number or export the file again");
  }
  return *value;
}

std::int64_t whole_number(std::string_view word, std::string_view what, const Scanner& place) {
  const auto value = integer_of(word);
  if (!value) place.refuse(text("'", shown(word), "' where ", what, " is expected"));
  return *value;
}

std::optional<std::string_view> Scanner::line() {
  if (at_end()) return std::nullopt;
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  const std::string_view found = bytes_.substr(at_, end - at_);
  at_ = std::min(end + 1, bytes_.size());
  line_ = line_ahead_++;
  return trimmed(found);
}

std::string_view Scanner::required_line(std::string_view what) {
  const auto found = line();
  if (!found) refuse(text("the file ends where ", what, " is expected"));
  return *found;
}

void Scanner::skip_blanks() {
  for (; at_ < bytes_.size() && kBlanks.find(bytes_[at_]) != std::string_view::npos; ++at_)
    if (bytes_[at_] == '\n') ++line_ahead_;
}

std::string_view Scanner::word() {
  skip_blanks();
  line_ = line_ahead_;
  const std::size_t end = std::min(bytes_.find_first_of(kBlanks, at_), bytes_.size());
  const std::string_view found = bytes_.substr(at_, end - at_);
  at_ = end;
  return found;
}

std::string_view Scanner::peek() {
  const auto before = std::tuple(at_, line_, line_ahead_);
  const std::string_view found = word();
  std::tie(at_, line_, line_ahead_) = before;
  return found;
}

double Scanner::real(std::string_view what) {
  const std::string_view found = word();
  if (found.empty()) refuse(text("the file ends where ", what, " is expected"));
  return finite_real(found, what, *this);
}

std::int64_t Scanner::integer(std::string_view what) {
  const std::string_view found = word();
  if (found.empty()) refuse(text("the file ends where ", what, " is expected"));
  return whole_number(found, what, *this);
}

std::size_t Scanner::count(std::string_view what, std::size_t smallest) {
  return checked_count(integer(what), what, smallest);
}

std::size_t Scanner::checked_count(std::int64_t number, std::string_view what,
                                   std::size_t smallest) const {
  if (number < 0) refuse(text(what, " is ", number));
  const auto found = static_cast<std::size_t>(number);
  if (found > bytes_left() / smallest) {
    refuse(text(what, " is ", number, ", more than the ", bytes_left(),
                " bytes that follow can hold"));
  }
  return found;
}

void Scanner::skip_past(std::string_view mark) {
  const std::size_t found = bytes_.find(mark, at_);
  if (found == std::string_view::npos) refuse(text("the file ends where ", mark, " is expected"));
  line_ahead_ += static_cast<std::size_t>(
      std::count(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                 bytes_.begin() + static_cast<std::ptrdiff_t>(found), '\n'));
  at_ = found + mark.size();
}

std::string_view Scanner::raw(std::size_t size, std::string_view what) {
  binary_ = true;
  if (size > bytes_left()) refuse(text("the file ends inside ", what));
  const std::string_view found = bytes_.substr(at_, size);
  at_ += size;
  return found;
}

std::string Scanner::where() const {
  return binary_ ? text(file_, ":byte ", at_) : text(file_, ":", std::max<std::size_t>(line_, 1));
}

void Scanner::refuse(const std::string& problem, const std::string& remedy) const {
  refuse_geometry(where(), problem, remedy);
}

void Fields::skip() {
  const std::size_t first = rest_.find_first_not_of(" \t\r");
  rest_.remove_prefix(std::min(first, rest_.size()));
}

std::string_view Fields::next() {
  const char separators[] = {separator_, separator_ == ' ' ? '\t' : separator_, '\0'};
  const std::size_t end = std::min(rest_.find_first_of(separators), rest_.size());
  const std::string_view field = trimmed(rest_.substr(0, end));
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  skip();
  return field;
}

double Fields::real(std::string_view what) {
  if (at_end()) place_.refuse(text("the line ends where ", what, " is expected"));
  return finite_real(next(), what, place_);
}

std::int64_t Fields::integer(std::string_view what) {
  if (at_end()) place_.refuse(text("the line ends where ", what, " is expected"));
  return whole_number(next(), what, place_);
}

}  // namespace palpate::mesher
