// SPDX-License-Identifier: AGPL-3.0-or-later
// The text of a table: its encoding, its lines, their fields, and the numbers in them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::measured {

/// The text in UTF-8 without a byte order mark. UTF-16 is recognised by its mark; bytes that are
/// not UTF-8 are read as Latin-1. Surrogate pairs of UTF-16 are not combined.
std::string as_utf8(std::string_view text);

struct Line {
  std::size_t number = 0;  ///< counted from 1
  std::string_view text;
};

/// The lines that are not blank. They refer to `text`.
std::vector<Line> lines_of(std::string_view text);

/// Stands for any run of blanks and tabs as the separator.
inline constexpr char kBlanks = ' ';

/// Fields of a line without the blanks around them. A quoted field may contain the separator; a
/// separator at the end of the line opens no field.
std::vector<std::string> split(std::string_view line, char separator);

/// The finite number that a field is, its digits possibly in groups of three: by blanks and
/// apostrophes, and by the other one of point and comma where the decimal sign follows. None where
/// the field is no such number.
std::optional<double> number_of(std::string field, char decimal);

}  // namespace palpate::measured
