// SPDX-License-Identifier: AGPL-3.0-or-later
// Reading of text, and of binary blocks between lines of text, with the place of every fault.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesher/read/file/file.hpp"

namespace palpate::mesher {

/// The number that fills the word; a sign before it is allowed. "nan" and "inf" count as numbers.
std::optional<double> real_of(std::string_view word);
std::optional<std::int64_t> integer_of(std::string_view word);

/// Reads the bytes of a file from front to back. It believes no count that the bytes left over
/// cannot hold. @throws Error(Geometry), with "file:line" or, behind a binary block,
/// "file:byte N", from every member that refuses.
class Scanner {
 public:
  /// `bytes` must outlive the scanner.
  Scanner(std::string_view bytes, std::string file) : bytes_(bytes), file_(std::move(file)) {}

  bool at_end() const { return at_ == bytes_.size(); }
  std::size_t bytes_left() const { return bytes_.size() - at_; }
  std::size_t position() const { return at_; }

  /// The next line without its end; nothing after the last one.
  std::optional<std::string_view> line();
  /// The next line, which must exist.
  std::string_view required_line(std::string_view what);

  /// The next word between blanks, over ends of lines; empty after the last one.
  std::string_view word();
  /// The next word without moving.
  std::string_view peek();
  double real(std::string_view what);
  std::int64_t integer(std::string_view what);
  /// The number of things that take up at least `smallest` bytes each.
  std::size_t count(std::string_view what, std::size_t smallest);
  /// The same for a number that has been read.
  std::size_t checked_count(std::int64_t number, std::string_view what, std::size_t smallest) const;

  /// Moves behind the next occurrence of `mark`.
  void skip_past(std::string_view mark);

  /// The next bytes as they are.
  std::string_view raw(std::size_t size, std::string_view what);
  /// A value of the byte order of this machine, or of the other one.
  template <class Number>
  Number binary(std::string_view what, bool swapped = false) {
    return decoded<Number>(raw(sizeof(Number), what), swapped);
  }
  template <class Number>
  static Number decoded(std::string_view bytes, bool swapped) {
    char copy[sizeof(Number)];
    for (std::size_t i = 0; i < sizeof copy; ++i)
      copy[i] = bytes[swapped ? sizeof copy - 1 - i : i];
    Number value;
    std::memcpy(&value, copy, sizeof copy);
    return value;
  }

  std::string where() const;
  [[noreturn]] void refuse(const std::string& problem,
                           const std::string& remedy = kDamagedFile) const;

 private:
  void skip_blanks();

  std::string_view bytes_;
  std::string file_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;        ///< of what was read last, from 1
  std::size_t line_ahead_ = 1;  ///< of what comes next
  bool binary_ = false;
};

/// The fields of one line, between blanks or between commas.
class Fields {
 public:
  Fields(std::string_view line, const Scanner& place, char separator = ' ')
      : rest_(line), place_(place), separator_(separator) {
    skip();
  }

  bool at_end() const { return rest_.empty(); }
  /// Empty after the last one, and where nothing stands between two commas.
  std::string_view next();
  double real(std::string_view what);
  std::int64_t integer(std::string_view what);

 private:
  void skip();

  std::string_view rest_;
  const Scanner& place_;
  char separator_;
};

/// A finite number. @throws Error(Geometry) at the place of the scanner.
double finite_real(std::string_view word, std::string_view what, const Scanner& place);
std::int64_t whole_number(std::string_view word, std::string_view what, const Scanner& place);

}  // namespace palpate::mesher
