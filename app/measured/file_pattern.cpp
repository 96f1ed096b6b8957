// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/file_pattern.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <sstream>
#include <system_error>

#include "fitting/measurement/records/csv_text.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

/// A part of a path between slashes, as a regular expression with a group for each name.
struct Part {
  std::regex expression;
  std::vector<std::string> names;
  std::string literal;  ///< where it has no placeholders
};

Part part_of(const std::string& text, const std::string& where) {
  Part part;
  std::string expression;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '{') {
      const std::size_t close = text.find('}', i);
      if (close == std::string::npos || close == i + 1)
        refuse(where, "'" + text + "' has a brace without a name or without its other one",
               "write {name} for what varies");
      part.names.push_back(text.substr(i + 1, close - i - 1));
      expression += "(.+?)";
      i = close;
    } else if (c == '*') {
      expression += ".*";
    } else if (c == '?') {
      expression += ".";
    } else {
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && static_cast<unsigned char>(c) < 0x80)
        expression += '\\';
      expression += c;
    }
  }
  if (!is_pattern(text)) part.literal = text;
  part.expression = std::regex(expression);
  return part;
}

/// "run-9" before "run-10": runs of digits count as numbers.
bool comes_before(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  const auto digit = [](const std::string& s, std::size_t at) {
    return at < s.size() && std::isdigit(static_cast<unsigned char>(s[at])) != 0;
  };
  while (i < a.size() && j < b.size()) {
    if (digit(a, i) && digit(b, j)) {
      std::size_t end_a = i, end_b = j;
      while (digit(a, end_a)) ++end_a;
      while (digit(b, end_b)) ++end_b;
      while (i + 1 < end_a && a[i] == '0') ++i;
      while (j + 1 < end_b && b[j] == '0') ++j;
      if (end_a - i != end_b - j) return end_a - i < end_b - j;
      const int order = a.compare(i, end_a - i, b, j, end_b - j);
      if (order != 0) return order < 0;
      i = end_a;
      j = end_b;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i;
      ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(folder.empty() ? "." : folder, none))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end(), comes_before);
  return names;
}

void descend(const fs::path& folder, const MatchedFile& so_far, const std::vector<Part>& parts,
             std::size_t depth, std::vector<MatchedFile>& found) {
  const Part& part = parts[depth];
  const bool last = depth + 1 == parts.size();
  const std::vector<std::string> names =
      part.literal.empty() ? names_in(folder / so_far.file) : std::vector{part.literal};
  for (const std::string& name : names) {
    std::smatch groups;
    // Hidden files match only where the pattern names them.
    if (part.literal.empty() &&
        (name.starts_with('.') || !std::regex_match(name, groups, part.expression)))
      continue;
    MatchedFile next{so_far.file / name, so_far.values};
    for (std::size_t i = 0; i < part.names.size(); ++i)
      next.values[part.names[i]] = groups[i + 1].str();
    std::error_code none;
    if (last && fs::is_regular_file(folder / next.file, none)) found.push_back(next);
    if (!last && fs::is_directory(folder / next.file, none))
      descend(folder, next, parts, depth + 1, found);
  }
}

void check_names(const std::vector<Part>& parts, const std::string& where) {
  std::vector<std::string> all;
  for (const Part& part : parts) all.insert(all.end(), part.names.begin(), part.names.end());
  std::sort(all.begin(), all.end());
  const auto twice = std::adjacent_find(all.begin(), all.end());
  if (twice != all.end())
    refuse(where, "{" + *twice + "} stands twice in the pattern", "give each part its own name");
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf()))
    refuse(file.string(), "the list cannot be read", "check path and permissions");
  return text.str();
}

}  // namespace

bool is_pattern(const std::string& text) {
  return text.find_first_of("*?{}") != std::string::npos;
}

std::vector<MatchedFile> matching_files(const fs::path& folder, const std::string& pattern,
                                        const std::string& where) {
  std::vector<Part> parts;
  MatchedFile start;
  for (const fs::path& part : fs::path(pattern)) {
    if (part == "/")
      start.file = part;
    else
      parts.push_back(part_of(part.string(), where));
  }
  if (parts.empty()) refuse(where, "the pattern is empty", "write for example \"*.csv\"");
  check_names(parts, where);
  std::vector<MatchedFile> found;
  descend(folder, start, parts, 0, found);
  if (found.empty())
    refuse(where,
           "no file matches '" + pattern + "' in " + (folder.empty() ? "." : folder.string()),
           "patterns are relative to the sidecar");
  return found;
}

std::string filled_in(const std::string& text, const NamedValues& values,
                      const std::string& where) {
  std::string filled;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t close = text[i] == '{' ? text.find('}', i) : std::string::npos;
    if (close == std::string::npos) {
      filled += text[i];
      continue;
    }
    const std::string name = text.substr(i + 1, close - i - 1);
    const auto value = values.find(name);
    if (value == values.end()) {
      std::string names;
      for (const auto& [known, ignored] : values)
        names.append(names.empty() ? "{" : ", {").append(known).append("}");
      refuse(where, fmt::format("'{}' uses {{{}}}, which nothing gives", text, name),
             names.empty() ? "name it in `files`, or give a `list`" : "known are " + names);
    }
    filled += value->second;
    i = close;
  }
  return filled;
}

std::vector<NamedValues> read_list(const fs::path& file) {
  const std::string utf8 = measured::as_utf8(text_of(file));
  const std::vector<measured::Line> lines = measured::lines_of(utf8);
  if (lines.size() < 2)
    refuse(file.string(), "the list has no rows",
           "write a header of names, and a row for each record");
  char separator = ',';
  for (const char candidate : {'\t', ';'})
    if (measured::split(lines[0].text, candidate).size() >
        measured::split(lines[0].text, separator).size())
      separator = candidate;
  const std::vector<std::string> names = measured::split(lines[0].text, separator);
  std::vector<NamedValues> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> fields = measured::split(lines[i].text, separator);
    const std::string where = file.string() + ":" + std::to_string(lines[i].number);
    if (fields.size() != names.size())
      refuse(where,
             "the row has " + std::to_string(fields.size()) + " fields, the header " +
                 std::to_string(names.size()),
             "mend the row");
    NamedValues& row = rows.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k)
      if (!row.emplace(names[k], fields[k]).second)
        refuse(file.string(), "the column '" + names[k] + "' stands twice", "rename one");
  }
  return rows;
}

}  // namespace palpate::app
