// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/wrapped_text.hpp"

#include <algorithm>
#include <functional>

namespace palpate::app {
namespace {

constexpr char kBlank = ' ';

/// Columns that a text takes.
std::size_t width(std::string_view text) {
  std::size_t columns = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\x1b') {
      i = std::min(text.find('m', i), text.size() - 1);
      continue;
    }
    const bool continues_letter = (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
    if (!continues_letter) ++columns;
  }
  return columns;
}

std::size_t indentation(std::string_view line) {
  return std::min(line.find_first_not_of(kBlank), line.size());
}

/// The blank at which a line is broken: the last one before `columns`, else the first one after.
/// npos where it has none behind its indentation.
std::size_t break_of(std::string_view line, std::size_t columns) {
  std::size_t best = std::string_view::npos;
  for (std::size_t at = line.find(kBlank, indentation(line)); at != std::string_view::npos;
       at = line.find(kBlank, at + 1)) {
    if (best != std::string_view::npos && width(line.substr(0, at)) > columns) break;
    best = at;
  }
  return best;
}

std::string wrapped_line(std::string_view line, std::size_t columns, std::size_t hanging) {
  std::string out, rest(line);
  while (width(rest) > columns) {
    const std::size_t at = break_of(rest, columns);
    if (at == std::string::npos) break;
    const std::size_t next = rest.find_first_not_of(kBlank, at);
    if (next == std::string::npos) break;
    out += rest.substr(0, rest.find_last_not_of(kBlank, at) + 1) + '\n';
    rest = std::string(hanging, kBlank) + rest.substr(next);
  }
  return out + rest;
}

/// A name, blanks, and a description from a column on; a long name of an option leaves one blank.
bool has_description(std::string_view line, std::size_t column) {
  const std::size_t name = indentation(line);
  if (name == 0 || column < 2 || line.size() <= column || line[column] == kBlank) return false;
  return line[column - 1] == kBlank && (line[column - 2] == kBlank || line[name] == '-');
}

std::string each_line(std::string_view text,
                      const std::function<std::string(std::string_view)>& change) {
  std::string out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    out += change(text.substr(begin, end - begin));
    if (end < text.size()) out += '\n';
    begin = end + 1;
  }
  return out;
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t columns, std::size_t hanging) {
  if (columns == 0) return std::string(text);
  return each_line(text, [&](std::string_view line) {
    return wrapped_line(line, columns, indentation(line) + hanging);
  });
}

std::string wrapped_help(std::string_view text, std::size_t columns, std::size_t description) {
  if (columns == 0) return std::string(text);
  return each_line(text, [&](std::string_view line) {
    const bool below = has_description(line, description);
    return wrapped_line(line, columns, below ? description : indentation(line) + 2);
  });
}

}  // namespace palpate::app
