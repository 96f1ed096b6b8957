// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/csv_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

#include "format/text.hpp"

namespace palpate::measured {
namespace {

void append_utf8(std::string& out, unsigned code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0 | (code >> 6));
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    out += static_cast<char>(0xE0 | (code >> 12));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  }
}

unsigned byte_at(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

/// Whether every byte beyond ASCII belongs to a sequence of its length.
bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const unsigned lead = byte_at(text, i);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte_at(text, i + k) & 0xC0) != 0x80) return false;
    }
    i += length;
  }
  return true;
}

std::vector<std::string> split_at_blanks(std::string_view line) {
  std::vector<std::string> fields;
  std::istringstream stream{std::string(line)};
  for (std::string field; stream >> field;) fields.push_back(field);
  return fields;
}

/// Without the marks that group its digits by three: blanks and apostrophes, and the other one of
/// point and comma where the decimal sign follows ("1,234" alone could be either). The field itself
/// where it is not grouped so.
std::string ungrouped(const std::string& field, char decimal) {
  std::string digits;
  char mark = 0;
  std::size_t in_group = 0;
  bool grouped = false;
  std::size_t i = field.starts_with('-') || field.starts_with('+') ? 1 : 0;
  digits.append(field, 0, i);
  for (; i < field.size() && field[i] != decimal; ++i) {
    const char c = field[i];
    if (c >= '0' && c <= '9') {
      digits += c;
      ++in_group;
      continue;
    }
    // No-break spaces, wide and narrow, in UTF-8.
    const std::string_view rest = std::string_view(field).substr(i);
    const std::size_t wide = rest.starts_with("\xC2\xA0")       ? 2
                             : rest.starts_with("\xE2\x80\xAF") ? 3
                                                                : 1;
    const char kind = wide > 1 ? ' ' : c;
    const bool known = kind == ' ' || kind == '\'' || kind == (decimal == '.' ? ',' : '.');
    const bool fits = grouped ? kind == mark && in_group == 3 : in_group >= 1 && in_group <= 3;
    if (!known || !fits) return field;
    grouped = true;
    mark = kind;
    in_group = 0;
    i += wide - 1;
  }
  const bool ambiguous = (mark == ',' || mark == '.') && i == field.size();
  if (!grouped || in_group != 3 || ambiguous) return field;
  return digits + field.substr(i);
}

}  // namespace

std::string as_utf8(std::string_view text) {
  const bool little = text.starts_with("\xFF\xFE"), big = text.starts_with("\xFE\xFF");
  std::string out;
  if (little || big) {
    for (std::size_t i = 2; i + 1 < text.size(); i += 2) {
      append_utf8(out,
                  byte_at(text, i + (little ? 1 : 0)) << 8 | byte_at(text, i + (little ? 0 : 1)));
    }
    return out;
  }
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  if (is_utf8(text)) return std::string(text);
  for (std::size_t i = 0; i < text.size(); ++i) append_utf8(out, byte_at(text, i));
  return out;
}

std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    if (!trimmed(line).empty()) lines.push_back({number, line});
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return lines;
}

std::vector<std::string> split(std::string_view line, char separator) {
  if (separator == kBlanks) return split_at_blanks(line);
  std::vector<std::string> fields{""};
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  for (std::string& field : fields) field = std::string(trimmed(field));
  // Many programs end every line with a separator.
  if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
  return fields;
}

std::optional<double> number_of(std::string field, char decimal) {
  field = ungrouped(field, decimal);
  if (decimal == ',') {
    if (field.find('.') != std::string::npos) return std::nullopt;
    std::replace(field.begin(), field.end(), ',', '.');
  }
  std::string_view text = field;
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

}  // namespace palpate::measured
